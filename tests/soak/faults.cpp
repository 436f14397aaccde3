#include "tests/soak/faults.h"

#include <algorithm>

namespace soak {
namespace {

using namespace std::chrono_literals;

constexpr Causes kAnyCause = {LossCause::kNotSent, LossCause::kNeverCame, LossCause::kIncomplete,
                              LossCause::kWrongSize, LossCause::kUnattributed};
constexpr rt::Nanoseconds kReopened = 2s;  // a revived camera shows frames again within this
constexpr rt::Nanoseconds kRealigned = 200ms;

constexpr std::array kKinds = {
    FaultKind{.name = "ignores triggers",
              .begin = "ignore-triggers 3",
              .lasts = 1s,
              .may_lose = {LossCause::kNotSent},
              .most_frames = 3},
    FaultKind{.name = "ignores every 2nd",
              .begin = "ignore-every 2",
              .end = "ignore-every 0",
              .may_lose = {LossCause::kNotSent}},
    // A camera that sends something of its own is not ready for the trigger that comes meanwhile.
    FaultKind{.name = "extra frame",
              .begin = "extra-frame",
              .lasts = 1s,
              .may_lose = {LossCause::kNotSent, LossCause::kUnattributed},
              .most_frames = 2},
    FaultKind{.name = "late leader",
              .begin = "late-leader 25",
              .lasts = 1s,
              .may_lose = {LossCause::kNotSent, LossCause::kUnattributed},
              .most_frames = 3},
    FaultKind{.name = "cable pulled",
              .begin = "kill",
              .end = "revive",
              .may_lose = kAnyCause,
              .recovery = kReopened,
              .named = true},
    FaultKind{.name = "frozen",
              .begin = "freeze",
              .end = "thaw",
              .may_lose = kAnyCause,
              .recovery = kReopened,
              .named = true},
    FaultKind{.name = "reboots",
              .begin = "reboot 1",
              .lasts = 1s,
              .may_lose = kAnyCause,
              .recovery = kReopened,
              .named = true},
    FaultKind{.name = "wrong size",
              .begin = "wrong-size on",
              .end = "wrong-size off",
              .may_lose = kAnyCause,
              .recovery = kReopened},
    FaultKind{.name = "clock drifts", .begin = "drift 100", .end = "drift 0"},
    FaultKind{.name = "loss 1 %", .begin = "loss 1", .end = "loss 0"},
    FaultKind{.name = "loss 30 %",
              .begin = "loss 30",
              .end = "loss 0",
              .may_lose = {LossCause::kNeverCame, LossCause::kIncomplete, LossCause::kUnattributed},
              .recovery = kRealigned},
    FaultKind{.name = "reorders 5 %", .begin = "reorder 5", .end = "reorder 0"},
    FaultKind{.name = "duplicates 5 %", .begin = "duplicate 5", .end = "duplicate 0"},
    FaultKind{.name = "link at 100 Mb/s",
              .begin = "link 100",
              .end = "clear",
              .may_lose = kAnyCause,
              .recovery = kReopened},
    FaultKind{.name = "large packets lost",
              .begin = "mtu 1500",
              .end = "clear",
              .may_lose = kAnyCause,
              .recovery = kReopened},
    FaultKind{.name = "frame ids jump",
              .begin = "frame-id 65530",
              .lasts = 1s,
              .may_lose = {LossCause::kNeverCame, LossCause::kIncomplete, LossCause::kUnattributed},
              .most_frames = 3},
};

}  // namespace

std::span<const FaultKind> faultKinds() {
  return kKinds;
}

const FaultKind* findFaultKind(std::string_view name) {
  const auto* const found = std::ranges::find(kKinds, name, &FaultKind::name);
  return found == kKinds.end() ? nullptr : found;
}

PlannedFault FaultPlan::next() {
  if (round_.empty()) {
    for (const FaultKind& kind : kinds_) round_.push_back(&kind);
    std::ranges::shuffle(round_, engine_);
  }
  const FaultKind* kind = round_.front();
  round_.pop_front();
  const auto camera = std::uniform_int_distribution<std::uint32_t>(0, cameras_ - 1)(engine_);
  const auto half = every_.count() / 2;
  const rt::Nanoseconds random{
      std::uniform_int_distribution<std::int64_t>(half / 4, half)(engine_)};
  return {kind, camera, kind->end.empty() ? kind->lasts : random};
}

}  // namespace soak

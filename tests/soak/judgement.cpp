#include "tests/soak/judgement.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "appliance/tools/stall_periods.h"

namespace soak {
namespace {

double seconds(rt::Nanoseconds time) {
  return static_cast<double>(time.count()) * 1e-9;
}

/// What a standstill of this machine may hide: a fault's own loss.
LossCause withoutStandstill(LossCause cause) {
  if (cause == LossCause::kLateEdge) return LossCause::kNotSent;
  return cause == LossCause::kHeldUp ? LossCause::kIncomplete : cause;
}

bool explains(const FaultOutcome& outcome, const LostFrame& lost, rt::Nanoseconds period) {
  const Fault& fault = outcome.fault;
  const LossCause cause = withoutStandstill(lost.cause);
  return fault.camera == lost.camera && fault.kind->may_lose.has(cause) &&
         lost.edge >= fault.from - 2 * period && lost.edge <= fault.until + fault.kind->recovery &&
         outcome.lostFrames() < fault.kind->most_frames;
}

template <class... Arguments>
std::string line(const char* format, Arguments... arguments) {
  std::array<char, 256> text{};
  (void)std::snprintf(text.data(), text.size(), format, arguments...);
  return text.data();
}

}  // namespace

std::uint64_t FaultOutcome::lostFrames() const {
  return std::accumulate(lost.begin(), lost.end(), std::uint64_t{0});
}

Judgement judge(std::span<const LostFrame> lost, std::span<const Fault> faults,
                std::span<const appliance::StallRecord> stalls, rt::Nanoseconds period) {
  Judgement judgement;
  const appliance::StallPeriods standstills(stalls, period);
  std::vector<std::vector<std::size_t>> of_camera;
  for (const Fault& fault : faults) {
    if (fault.camera >= of_camera.size()) of_camera.resize(fault.camera + 1);
    of_camera[fault.camera].push_back(judgement.faults.size());
    judgement.faults.push_back({.fault = fault});
  }
  for (const LostFrame& frame : lost) {
    FaultOutcome* explained = nullptr;
    if (frame.camera < of_camera.size()) {
      for (const std::size_t i : of_camera[frame.camera]) {  // the latest one that fits
        if (explains(judgement.faults[i], frame, period)) explained = &judgement.faults[i];
      }
    }
    if (explained == nullptr) {
      const bool stood_still =
          withoutStandstill(frame.cause) != frame.cause || standstills.mayHaveCost(frame.edge);
      (stood_still ? judgement.stood_still : judgement.unexplained).push_back(frame);
      continue;
    }
    ++explained->lost[static_cast<std::size_t>(frame.cause)];
    const rt::Nanoseconds back = frame.edge + period - explained->fault.until;
    explained->back_after = std::max(explained->back_after, back);
  }
  return judgement;
}

std::string faultTable(const Judgement& judgement, rt::Timestamp start) {
  std::string text = line("%9s  %6s  %-18s %7s %6s", "at", "camera", "fault", "lasted", "lost");
  for (std::size_t i = 0; i < kLossCauses; ++i) {
    text += line("  %12s", std::string(nameOf(static_cast<LossCause>(i))).c_str());
  }
  text += line("  %10s  %s\n", "back after", "named");
  for (const FaultOutcome& one : judgement.faults) {
    const Fault& fault = one.fault;
    text += line("%7.1f s  %6u  %-18s %5.1f s %6llu", seconds(fault.from - start), fault.camera + 1,
                 std::string(fault.kind->name).c_str(), seconds(fault.until - fault.from),
                 static_cast<unsigned long long>(one.lostFrames()));
    for (const std::uint64_t count : one.lost) {
      text += line("  %12llu", static_cast<unsigned long long>(count));
    }
    text += line("  %8.3f s  %s\n", seconds(one.back_after), fault.named ? "yes" : "-");
  }
  return text;
}

std::string kindTable(const Judgement& judgement) {
  std::string text = line("%-18s %6s %12s %16s %6s\n", "fault", "times", "frames lost",
                          "longest recovery", "named");
  for (const FaultKind& kind : faultKinds()) {
    std::uint64_t times = 0;
    std::uint64_t lost = 0;
    std::uint64_t named = 0;
    rt::Nanoseconds longest{0};
    for (const FaultOutcome& one : judgement.faults) {
      if (one.fault.kind != &kind) continue;
      ++times;
      lost += one.lostFrames();
      if (one.fault.named) ++named;
      longest = std::max(longest, one.back_after);
    }
    if (times == 0) continue;
    text += line("%-18s %6llu %12llu %14.3f s %6llu\n", std::string(kind.name).c_str(),
                 static_cast<unsigned long long>(times), static_cast<unsigned long long>(lost),
                 seconds(longest), static_cast<unsigned long long>(named));
  }
  return text;
}

std::string describe(const LostFrame& lost, rt::Timestamp start) {
  return line("camera %u, trigger %llu at %.3f s: %s", lost.camera + 1,
              static_cast<unsigned long long>(lost.trigger), seconds(lost.edge - start),
              std::string(nameOf(lost.cause)).c_str());
}

}  // namespace soak

#include "appliance/control/control_requests.h"

#include <chrono>
#include <cmath>

#include "rt/printable.h"

namespace appliance {
namespace {

using Kind = Command::Kind;

constexpr std::size_t kLargestRigFile_bytes = 1U << 20;
constexpr double kFarthestTargetMetres = 1000;  // beyond any hall; a slip of the decimal point

}  // namespace

Requested requestMode(std::string_view mode) {
  if (mode == "live") return Command{Kind::kGoLive};
  if (mode == "frozen") return Command{Kind::kFreeze};
  if (mode == "sweep") return Command{Kind::kStartSweep};
  if (mode == "delayed") return std::unexpected(phrase<Word::kModeNeedsDelay>());
  if (mode == "slow") return std::unexpected(phrase<Word::kModeNeedsSpeed>());
  return std::unexpected(phrase<Word::kNoSuchMode>(rt::printable(mode)));
}

Requested requestDelay(std::uint32_t delay_ms, const Status& now) {
  if (delay_ms > now.history_ms)
    return std::unexpected(phrase<Word::kDelayTooLong>(delay_ms, now.history_ms));
  return Command{.kind = Kind::kSetDelay, .delay = std::chrono::milliseconds(delay_ms)};
}

Requested requestView(std::uint32_t view, const Status& now) {
  if (view < 1 || view > now.cameras.size())
    return std::unexpected(phrase<Word::kNoSuchView>(view, now.cameras.size()));
  return Command{.kind = Kind::kSetView, .camera = view - 1};
}

Phrase refusalOf(CommandOutcome outcome) {
  switch (outcome) {
    case CommandOutcome::kApplied:
      break;
    case CommandOutcome::kNoPictureYet:
      return phrase<Word::kNoPictureYet>();
    case CommandOutcome::kNoSuchView:
      return phrase<Word::kViewIsGone>();
    case CommandOutcome::kAtMemorysEnd:
      return phrase<Word::kAtMemorysEnd>();
    case CommandOutcome::kNothingNewer:
      return phrase<Word::kNothingNewer>();
  }
  return {};
}

Requested requestSpeed(std::string_view rate) {
  const auto known = rateNamed(rate);
  if (!known) return std::unexpected(phrase<Word::kNoSuchSpeed>(rt::printable(rate)));
  return Command{.kind = Kind::kSetRate, .rate = *known};
}

Requested requestReplay(std::uint32_t delay_ms, std::string_view rate, const Status& now) {
  const auto speed = requestSpeed(rate);
  if (!speed) return speed;
  if (speed->rate == Rate::kStill) return std::unexpected(phrase<Word::kReplayNeedsSpeed>());
  auto replay = requestDelay(delay_ms, now);
  if (!replay) return replay;
  return Command{.kind = Kind::kReplay, .delay = replay->delay, .rate = speed->rate};
}

Requested requestCompare(std::string_view layout, std::uint32_t view, std::uint32_t earlier_ms,
                         double share, const Status& now) {
  const auto known = layoutNamed(layout);
  if (!known) return std::unexpected(phrase<Word::kNoSuchLayout>(rt::printable(layout)));
  Command command{.kind = Kind::kCompare, .camera = Command::kSameView};
  if (*known == Layout::kSingle) return command;
  if (!(share >= 0 && share <= 1)) return std::unexpected(phrase<Word::kShareOutOfRange>());
  if (view == 0 && earlier_ms == 0) return std::unexpected(phrase<Word::kNothingToCompare>());
  if (view != 0) {
    const auto second = requestView(view, now);
    if (!second) return second;
    command.camera = second->camera;
  }
  const auto earlier = requestDelay(earlier_ms, now);
  if (!earlier) return earlier;
  command.delay = earlier->delay;
  command.composition = {.layout = *known, .share = static_cast<float>(share)};
  return command;
}

std::expected<std::array<double, 3>, Phrase> requestTarget(double x_m, double y_m, double z_m) {
  const std::array<double, 3> target_m{x_m, y_m, z_m};
  for (const double coordinate : target_m) {
    if (std::isfinite(coordinate) && std::abs(coordinate) <= kFarthestTargetMetres) continue;
    return std::unexpected(phrase<Word::kTargetTooFar>(x_m, y_m, z_m, kFarthestTargetMetres));
  }
  return target_m;
}

std::expected<std::string, Phrase> requestRig(std::string_view text) {
  if (text.size() > kLargestRigFile_bytes)
    return std::unexpected(phrase<Word::kRigFileTooLarge>(text.size()));
  return std::string(text);
}

}  // namespace appliance

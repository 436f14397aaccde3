#include "appliance/control/control_requests.h"

#include <chrono>
#include <cmath>
#include <cstdio>

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
  if (mode == "delayed")
    return std::unexpected("mode delayed is entered by its delay: set a delay in milliseconds");
  if (mode == "slow")
    return std::unexpected("mode slow is entered by its speed: set a speed of 1/2, 1/4 or 1/8");
  return std::unexpected("unknown mode \"" + rt::printable(mode) +
                         "\": the modes are live, delayed, slow, frozen and sweep");
}

Requested requestDelay(std::uint32_t delay_ms, const Status& now) {
  if (delay_ms > now.history_ms)
    return std::unexpected("a delay of " + std::to_string(delay_ms) +
                           " ms is longer than the stored " + std::to_string(now.history_ms) +
                           " ms");
  return Command{.kind = Kind::kSetDelay, .delay = std::chrono::milliseconds(delay_ms)};
}

Requested requestView(std::uint32_t view, const Status& now) {
  if (view < 1 || view > now.cameras.size())
    return std::unexpected("there is no view " + std::to_string(view) + ": the views are 1 to " +
                           std::to_string(now.cameras.size()));
  return Command{.kind = Kind::kSetView, .camera = view - 1};
}

std::string_view refusalOf(CommandOutcome outcome) {
  switch (outcome) {
    case CommandOutcome::kApplied:
      return "";
    case CommandOutcome::kNoPictureYet:
      return "no picture was shown yet, so there is no moment to stop at: wait for the cameras";
    case CommandOutcome::kNoSuchView:
      return "there is no such view";
    case CommandOutcome::kAtMemorysEnd:
      return "that moment is no longer stored: this is the oldest one";
    case CommandOutcome::kNothingNewer:
      return "that moment has not come yet: this is the newest one";
  }
  return "";
}

Requested requestSpeed(std::string_view rate) {
  const auto known = rateNamed(rate);
  if (!known)
    return std::unexpected("unknown speed \"" + rt::printable(rate) +
                           "\": the speeds are 1, 1/2, 1/4, 1/8 and 0");
  return Command{.kind = Kind::kSetRate, .rate = *known};
}

Requested requestReplay(std::uint32_t delay_ms, std::string_view rate, const Status& now) {
  const auto speed = requestSpeed(rate);
  if (!speed) return speed;
  if (speed->rate == Rate::kStill)
    return std::unexpected("a replay at speed 0 has no end: the speeds are 1, 1/2, 1/4 and 1/8");
  auto replay = requestDelay(delay_ms, now);
  if (!replay) return replay;
  return Command{.kind = Kind::kReplay, .delay = replay->delay, .rate = speed->rate};
}

Requested requestCompare(std::string_view layout, std::uint32_t view, std::uint32_t earlier_ms,
                         double share, const Status& now) {
  const auto known = layoutNamed(layout);
  if (!known)
    return std::unexpected("unknown layout \"" + rt::printable(layout) +
                           "\": the layouts are single, side-by-side, ghost and wipe");
  Command command{.kind = Kind::kCompare, .camera = Command::kSameView};
  if (*known == Layout::kSingle) return command;
  if (!(share >= 0 && share <= 1)) return std::unexpected("the share is not a number from 0 to 1");
  if (view == 0 && earlier_ms == 0)
    return std::unexpected(
        "the same view of the same moment: name another view, or how much earlier");
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

std::expected<std::array<double, 3>, std::string> requestTarget(double x_m, double y_m,
                                                                double z_m) {
  const std::array<double, 3> target_m{x_m, y_m, z_m};
  for (const double coordinate : target_m) {
    if (std::isfinite(coordinate) && std::abs(coordinate) <= kFarthestTargetMetres) continue;
    std::array<char, 120> message{};
    (void)std::snprintf(message.data(), message.size(),
                        "the target (%g, %g, %g) is not three coordinates in metres within %g m",
                        x_m, y_m, z_m, kFarthestTargetMetres);
    return std::unexpected(message.data());
  }
  return target_m;
}

std::expected<std::string, std::string> requestRig(std::string_view text) {
  if (text.size() > kLargestRigFile_bytes)
    return std::unexpected("a rig file of " + std::to_string(text.size()) +
                           " bytes is larger than 1 MiB: is it a rig file?");
  return std::string(text);
}

}  // namespace appliance

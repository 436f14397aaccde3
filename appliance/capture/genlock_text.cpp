#include "appliance/capture/genlock_text.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "appliance/capture/genlock.h"

namespace appliance {
namespace {

constexpr int kLargestTerm = 12;

/// "2:3" for 40 Hz on 60 Hz; empty where no ratio of small numbers is near.
std::string ratioText(double trigger_hz, double refresh_hz) {
  for (int q = 1; q <= kLargestTerm; ++q) {
    const double p = std::round(trigger_hz / refresh_hz * q);
    if (p < 1 || p > kLargestTerm) continue;
    if (std::abs(trigger_hz / refresh_hz * q / p - 1) > Genlock::kMostMistuned) continue;
    return std::to_string(std::lround(p)) + ":" + std::to_string(q);
  }
  return {};
}

std::string mistunedText(double trigger_hz, double refresh_hz) {
  const std::string ratio = ratioText(trigger_hz, refresh_hz);
  const double vblanks = std::floor(refresh_hz / trigger_hz);
  std::array<char, 240> text{};
  const int length = std::snprintf(
      text.data(), text.size(),
      "free-running: triggers of %.6g Hz on a screen of %.6g Hz are %s: trigger.rate_hz = ",
      trigger_hz, refresh_hz, ratio.empty() ? "in no simple ratio" : ratio.c_str());
  const auto rest = static_cast<std::size_t>(length);
  if (vblanks >= 1) {
    (void)std::snprintf(text.data() + rest, text.size() - rest, "%.6g or %.6g would lock",
                        refresh_hz / (vblanks + 1), refresh_hz / vblanks);
  } else {
    (void)std::snprintf(text.data() + rest, text.size() - rest, "%.6g would lock", refresh_hz);
  }
  return text.data();
}

std::string lockedText(const GenlockStatus& status) {
  std::array<char, 160> text{};
  (void)std::snprintf(text.data(), text.size(),
                      "locked: a trigger every %u vblanks of %.6g Hz, %.1f us rms off, page flip "
                      "%.1f ms after the trigger%s",
                      status.vblanks_per_trigger, 1e9 / status.vblank_period_ns,
                      status.phase_error_rms_ns / 1e3,
                      static_cast<double>(status.lead.count()) / 1e6,
                      status.hold_over ? "; held over, no page flips just now" : "");
  return text.data();
}

}  // namespace

std::string genlockText(const GenlockStatus& status, double trigger_hz) {
  switch (status.state) {
    case GenlockState::kOff:
      return "off: trigger.genlock = false";
    case GenlockState::kLocked:
      return lockedText(status);
    case GenlockState::kAcquiring:
      return status.reason == GenlockReason::kPhaseLost
                 ? "acquiring: the vblanks were not where they were expected"
                 : "acquiring: moving the triggers into phase";
    case GenlockState::kFreeRunning:
      break;
  }
  switch (status.reason) {
    case GenlockReason::kRatio:
      return mistunedText(trigger_hz, 1e9 / status.vblank_period_ns);
    case GenlockReason::kNoFrames:
      return "free-running: too few live frames were shown so far";
    default:
      return "free-running: the screen's vblanks are not known: no screen, or nothing new on it";
  }
}

}  // namespace appliance

#include "appliance/capture/genlock_text.h"

#include <cmath>
#include <cstdint>
#include <optional>

#include "appliance/capture/genlock.h"

namespace appliance {
namespace {

constexpr int kLargestTerm = 12;

struct Ratio {
  long p;
  int q;
};

/// 2 to 3 for 40 Hz on 60 Hz; nothing if no ratio of small numbers is near.
std::optional<Ratio> ratioOf(double trigger_hz, double refresh_hz) {
  for (int q = 1; q <= kLargestTerm; ++q) {
    const double p = std::round(trigger_hz / refresh_hz * q);
    if (p < 1 || p > kLargestTerm) continue;
    if (std::abs(trigger_hz / refresh_hz * q / p - 1) > Genlock::kMostMistuned) continue;
    return Ratio{std::lround(p), q};
  }
  return std::nullopt;
}

Phrase mistuned(double trigger_hz, double refresh_hz) {
  const auto ratio = ratioOf(trigger_hz, refresh_hz);
  return ratio ? phrase<Word::kGenlockRatio>(trigger_hz, refresh_hz, ratio->p, ratio->q)
               : phrase<Word::kGenlockNoRatio>(trigger_hz, refresh_hz);
}

/// Trigger rates that would lock.
Phrase betterRates(double trigger_hz, double refresh_hz) {
  const double vblanks = std::floor(refresh_hz / trigger_hz);
  return vblanks >= 1
             ? phrase<Word::kGenlockWouldLockTwo>(refresh_hz / (vblanks + 1), refresh_hz / vblanks)
             : phrase<Word::kGenlockWouldLock>(refresh_hz);
}

Phrase locked(const GenlockStatus& status) {
  return phrase<Word::kGenlockLocked>(status.vblanks_per_trigger, 1e9 / status.vblank_period_ns,
                                      status.phase_error_rms_ns / 1e3,
                                      static_cast<double>(status.lead.count()) / 1e6);
}

Phrase freeRunning(const GenlockStatus& status, double trigger_hz) {
  switch (status.reason) {
    case GenlockReason::kRatio:
      return mistuned(trigger_hz, 1e9 / status.vblank_period_ns);
    case GenlockReason::kNoFrames:
      return phrase<Word::kGenlockNoFrames>();
    default:
      return phrase<Word::kGenlockNoVblanks>();
  }
}

}  // namespace

Phrase genlockPhrase(const GenlockStatus& status, double trigger_hz) {
  switch (status.state) {
    case GenlockState::kOff:
      return phrase<Word::kGenlockOff>();
    case GenlockState::kLocked:
      return locked(status);
    case GenlockState::kAcquiring:
      return status.reason == GenlockReason::kPhaseLost ? phrase<Word::kGenlockReacquiring>()
                                                        : phrase<Word::kGenlockAcquiring>();
    case GenlockState::kFreeRunning:
      break;
  }
  return freeRunning(status, trigger_hz);
}

std::string genlockText(const GenlockStatus& status, double trigger_hz) {
  std::string text = textOf(genlockPhrase(status, trigger_hz));
  if (status.state == GenlockState::kLocked && status.hold_over)
    text += "; " + textOf(phrase<Word::kGenlockHeldOver>());
  if (status.state == GenlockState::kFreeRunning && status.reason == GenlockReason::kRatio)
    text += "; " + textOf(betterRates(trigger_hz, 1e9 / status.vblank_period_ns));
  return text;
}

}  // namespace appliance

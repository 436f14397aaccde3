#include "appliance/capture/genlock_text.h"

#include <cmath>
#include <cstdint>
#include <optional>

#include "appliance/capture/genlock.h"
#include "appliance/words/phrase.h"

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

std::string mistunedText(double trigger_hz, double refresh_hz) {
  const auto ratio = ratioOf(trigger_hz, refresh_hz);
  const double vblanks = std::floor(refresh_hz / trigger_hz);
  const Phrase now = ratio ? phrase<Word::kGenlockRatio>(trigger_hz, refresh_hz, ratio->p, ratio->q)
                           : phrase<Word::kGenlockNoRatio>(trigger_hz, refresh_hz);
  const Phrase better = vblanks >= 1 ? phrase<Word::kGenlockWouldLockTwo>(
                                           refresh_hz / (vblanks + 1), refresh_hz / vblanks)
                                     : phrase<Word::kGenlockWouldLock>(refresh_hz);
  return textOf(now) + "; " + textOf(better);
}

std::string lockedText(const GenlockStatus& status) {
  std::string text = textOf(phrase<Word::kGenlockLocked>(
      status.vblanks_per_trigger, 1e9 / status.vblank_period_ns, status.phase_error_rms_ns / 1e3,
      static_cast<double>(status.lead.count()) / 1e6));
  if (status.hold_over) text += "; " + textOf(phrase<Word::kGenlockHeldOver>());
  return text;
}

}  // namespace

std::string genlockText(const GenlockStatus& status, double trigger_hz) {
  switch (status.state) {
    case GenlockState::kOff:
      return textOf(phrase<Word::kGenlockOff>());
    case GenlockState::kLocked:
      return lockedText(status);
    case GenlockState::kAcquiring:
      return textOf(status.reason == GenlockReason::kPhaseLost ? phrase<Word::kGenlockReacquiring>()
                                                               : phrase<Word::kGenlockAcquiring>());
    case GenlockState::kFreeRunning:
      break;
  }
  switch (status.reason) {
    case GenlockReason::kRatio:
      return mistunedText(trigger_hz, 1e9 / status.vblank_period_ns);
    case GenlockReason::kNoFrames:
      return textOf(phrase<Word::kGenlockNoFrames>());
    default:
      return textOf(phrase<Word::kGenlockNoVblanks>());
  }
}

}  // namespace appliance

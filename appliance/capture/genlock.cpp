#include "appliance/capture/genlock.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace appliance {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kLockWithin = 100us;
constexpr std::uint32_t kLockAfter = 4;  // triggers in a row
constexpr rt::Nanoseconds kUnlockBeyond = 500us;
constexpr rt::Nanoseconds kSilence = 500ms;  // and two periods: then it is hold-over
constexpr double kLeadSlew = 0.002;          // of a period, per trigger
constexpr int kLeadSlack = 4;                // a part of the margin that lead need not follow
constexpr double kRmsMemory = 64;            // triggers

rt::Nanoseconds nanoseconds(double ns) {
  return rt::Nanoseconds(std::llround(ns));
}

}  // namespace

Genlock::Genlock(const Parameters& parameters) : parameters_(parameters) {
  assert(parameters.period > 0ns && parameters.margin >= 0ns);
  if (!parameters.enabled) return;
  status_.state = GenlockState::kFreeRunning;
  status_.reason = GenlockReason::kNoVblanks;
}

void Genlock::take(const GenlockInput& input) RT_SAFE {
  if (input.timing) input_.timing = input.timing;
  if (input.ready_delay > 0ns) input_.ready_delay = input.ready_delay;
}

GenlockReason Genlock::obstacle(rt::Timestamp deadline) const RT_SAFE {
  const auto& timing = input_.timing;
  if (!timing || deadline - timing->at > kHoldOver) return GenlockReason::kNoVblanks;
  const double vblanks = static_cast<double>(parameters_.period.count()) / timing->period_ns;
  const double whole = std::round(vblanks);
  if (whole < 1 || std::abs(whole / vblanks - 1) > kMostMistuned) return GenlockReason::kRatio;
  if (input_.ready_delay == 0ns) return GenlockReason::kNoFrames;
  return GenlockReason::kNone;
}

rt::Nanoseconds Genlock::step(rt::Timestamp deadline) RT_SAFE {
  if (!parameters_.enabled) return 0ns;
  status_.vblank_period_ns = input_.timing ? input_.timing->period_ns : 0;
  if (const GenlockReason reason = obstacle(deadline); reason != GenlockReason::kNone) {
    leave(GenlockState::kFreeRunning, reason);
    return 0ns;
  }
  const hal::DisplayTiming& timing = *input_.timing;
  const auto period_ns = static_cast<double>(parameters_.period.count());
  const double vblanks = std::round(period_ns / timing.period_ns);
  if (status_.state == GenlockState::kFreeRunning) {
    status_.state = GenlockState::kAcquiring;
    status_.reason = GenlockReason::kNone;
  }
  status_.vblanks_per_trigger = static_cast<std::uint32_t>(vblanks);
  status_.hold_over = deadline - timing.at > kSilence + 2 * parameters_.period;

  const rt::Nanoseconds mistuned = nanoseconds(vblanks * timing.period_ns - period_ns);
  const rt::Nanoseconds lead_step = moveLead();
  // Where this trigger's picture would come on screen, against the vblank nearest to that.
  const rt::Timestamp flip = deadline + mistuned + status_.lead - lead_step;
  const rt::Nanoseconds half = nanoseconds(timing.period_ns / 2);
  const rt::Nanoseconds error = flip - timing.vblankAt(timing.firstVblankAfter(flip - half));
  judge(error);

  const rt::Nanoseconds most = nanoseconds(kMostSlew * period_ns);
  return mistuned + std::clamp(-error - lead_step, -most, most);
}

/// Sets the lead to the sum of its parts when a phase is first searched for. Later it follows that
/// sum slowly, and only if they differ by more than the slack. Returns how far it moved.
rt::Nanoseconds Genlock::moveLead() RT_SAFE {
  const rt::Nanoseconds wanted =
      input_.ready_delay + parameters_.margin + input_.timing->draw + input_.timing->commit_margin;
  const rt::Nanoseconds missing = wanted - status_.lead;
  if (status_.lead == 0ns) {
    status_.lead = wanted;
    return 0ns;
  }
  if (std::chrono::abs(missing) > parameters_.margin / kLeadSlack) lead_moving_ = true;
  if (!lead_moving_) return 0ns;
  const rt::Nanoseconds most =
      nanoseconds(kLeadSlew * static_cast<double>(parameters_.period.count()));
  const rt::Nanoseconds moved = std::clamp(missing, -most, most);
  status_.lead += moved;
  lead_moving_ = moved != missing;
  return moved;
}

void Genlock::judge(rt::Nanoseconds error) RT_SAFE {
  status_.phase_error = error;
  const rt::Nanoseconds size = std::chrono::abs(error);
  if (status_.state == GenlockState::kLocked) {
    if (size > kUnlockBeyond) return leave(GenlockState::kAcquiring, GenlockReason::kPhaseLost);
    const auto ns = static_cast<double>(error.count());
    const double square = status_.phase_error_rms_ns * status_.phase_error_rms_ns;
    const double memory = std::min<double>(++locked_for_, kRmsMemory);
    status_.phase_error_rms_ns = std::sqrt(square + (ns * ns - square) / memory);
    return;
  }
  good_in_a_row_ = size <= kLockWithin ? good_in_a_row_ + 1 : 0;
  if (good_in_a_row_ < kLockAfter) return;
  status_.state = GenlockState::kLocked;
  status_.reason = GenlockReason::kNone;
  status_.phase_error_rms_ns = 0;
  locked_for_ = 0;
}

void Genlock::leave(GenlockState to, GenlockReason reason) RT_SAFE {
  if (status_.state == GenlockState::kLocked) {
    ++status_.unlocks;
    status_.last_unlock = reason;
  }
  status_.state = to;
  status_.reason = reason;
  good_in_a_row_ = 0;
  if (to == GenlockState::kAcquiring) return;
  status_.vblanks_per_trigger = 0;
  status_.hold_over = false;
  status_.phase_error = 0ns;
  status_.lead = 0ns;
  lead_moving_ = false;
}

}  // namespace appliance

#pragma once

#include <cstdint>

#include "appliance/director/presentation.h"
#include "appliance/director/rate.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// The position in stored time: a trigger and the part of its duration that has been shown. It is
/// pure: it moves by the instants that it is given.
///
/// On a screen with vblanks it counts vblanks, because every trigger is shown for whole vblanks.
/// If a trigger at this rate lasts a whole number of vblanks within kEvenWithin, each trigger gets
/// exactly that many: the playback then follows the screen's clock and not the nominal period.
/// Otherwise the vblanks of two triggers differ by one at most.
///
/// Threads  One: the render thread.
/// RT       RT safe.
/// Units    Positions are triggers.
class Playhead {
 public:
  /// As the genlock's tolerance: what it locks is played evenly.
  static constexpr double kEvenWithin = 0.005;
  /// A playhead that is farther than this from where it should be jumps there.
  static constexpr std::int64_t kFar_triggers = 8;

  /// Jumps: @p trigger is shown from the present picture on, for its whole duration.
  void seek(std::uint64_t trigger) RT_SAFE;

  void setRate(Rate rate) RT_SAFE { rate_ = rate; }

  /// Moves on to the picture @p to at the present rate. An instant in the past changes nothing.
  void advance(const Presentation& to, rt::Nanoseconds trigger_period) RT_SAFE;

  /// Stays near @p wanted, the newest moment less a delay, which moves on by itself. A distance of
  /// one trigger is accepted, because a picture is decided between two triggers. If the two clocks
  /// drift apart, the playhead skips or repeats one trigger from time to time; it never goes back.
  void keepNear(std::uint64_t wanted) RT_SAFE;

  [[nodiscard]] Rate rate() const RT_SAFE { return rate_; }
  [[nodiscard]] std::uint64_t trigger() const RT_SAFE { return trigger_; }
  /// Of the trigger's duration, from 0 up to 1.
  [[nodiscard]] double fraction() const RT_SAFE { return fraction_; }

 private:
  void advanceByVblanks(std::uint64_t vblanks, double triggers_per_vblank) RT_SAFE;
  void advanceBy(double triggers) RT_SAFE;

  Rate rate_ = Rate::kFull;
  rt::Timestamp at_;  // of the present picture; the epoch: none yet
  std::uint64_t trigger_ = 0;
  double fraction_ = 0;
  std::uint64_t before_ = 0;  // the trigger before the last advance or jump
};

}  // namespace appliance

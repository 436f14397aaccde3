#pragma once

#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// The view's way along the arc from one angle to another, as a function of time. The caller that
/// interrupts a move starts the next one at angle(t): the view never jumps.
///
/// RT       Every member is RT safe: arithmetic.
struct Move {
  double from_deg = 0;
  double to_deg = 0;
  double speed_deg_per_s = 0;  ///< between the eased ends; not above 0: the move takes no time
  /// The share of the way at each end that speeds up, or slows down, evenly: from 0 to 0.5.
  double ease = 0;
  rt::Nanoseconds pause{};  ///< the view rests at the end before the move is over
  rt::Timestamp begin;

  [[nodiscard]] double angle(rt::Timestamp t) const RT_SAFE;
  [[nodiscard]] rt::Timestamp arrival() const RT_SAFE;  ///< at to_deg
  [[nodiscard]] rt::Timestamp end() const RT_SAFE { return arrival() + pause; }
};

}  // namespace appliance

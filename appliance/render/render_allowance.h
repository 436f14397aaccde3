#pragma once

#include "rt/clock.h"

namespace appliance {

/// Rate limit for drawing: in any interval T, pictures take at most share * (T + burst). The
/// renderer has a higher priority than the receive threads and must leave them time on each CPU.
///
/// The burst lets the next pictures follow one slow picture immediately, so that the delay is
/// caught up. Only a renderer that is always slow has to pause. It is the generic cell rate
/// algorithm (ITU-T I.371, annex A) with a picture's duration as the cell.
///
/// Threads  One at a time; pure.
class RenderAllowance {
 public:
  /// @p share of the time, above 0 and at most 1.
  RenderAllowance(double share, rt::Nanoseconds burst) : share_(share), burst_(burst) {}

  void spend(rt::Timestamp begin, rt::Timestamp end) noexcept {
    const double earned_ns = static_cast<double>((end - begin).count()) / share_;
    if (paid_at_ < begin) paid_at_ = begin;
    paid_at_ += rt::Nanoseconds(static_cast<rt::Nanoseconds::rep>(earned_ns));
  }

  /// The epoch before the first picture; may be in the past.
  [[nodiscard]] rt::Timestamp nextBegin() const noexcept { return paid_at_ - burst_; }

 private:
  double share_;
  rt::Nanoseconds burst_;
  rt::Timestamp paid_at_;  // when the allowance for all pictures so far will be earned
};

}  // namespace appliance

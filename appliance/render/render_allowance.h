#pragma once

#include "rt/clock.h"

namespace appliance {

/// When the next picture may begin, so that a renderer that stands above receiving leaves it
/// enough of every processor: the pictures between two begins that are T apart take at most
/// share * (T + burst).
///
/// A picture that took long is thus followed at once by the next ones, up to the burst, and what
/// came late is caught up with; only a renderer that is always slow rests. It is the generic cell
/// rate algorithm (ITU-T I.371, annex A) with a picture's duration as the cell.
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
  rt::Timestamp paid_at_;  // when what was spent so far will have been earned
};

}  // namespace appliance

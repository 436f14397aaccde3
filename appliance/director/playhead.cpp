#include "appliance/director/playhead.h"

#include <algorithm>
#include <cmath>

namespace appliance {

void Playhead::seek(std::uint64_t trigger) RT_SAFE {
  trigger_ = before_ = trigger;
  fraction_ = 0;
}

void Playhead::advance(const Presentation& to, rt::Nanoseconds trigger_period) RT_SAFE {
  before_ = trigger_;
  const bool first = at_ == rt::Timestamp{};
  if (first || rate_ == Rate::kStill || trigger_period <= rt::Nanoseconds::zero()) {
    at_ = std::max(at_, to.at);
    return;
  }
  if (to.at <= at_) return;
  const auto elapsed_ns = static_cast<double>((to.at - at_).count());
  const double triggers_per_ns = factorOf(rate_) / static_cast<double>(trigger_period.count());
  if (to.refresh > rt::Nanoseconds::zero()) {
    const auto refresh_ns = static_cast<double>(to.refresh.count());
    const double vblanks = std::round(elapsed_ns / refresh_ns);
    if (vblanks < 1) return;
    advanceByVblanks(static_cast<std::uint64_t>(vblanks), triggers_per_ns * refresh_ns);
  } else {
    advanceBy(triggers_per_ns * elapsed_ns);
  }
  at_ = to.at;
}

/// Half a vblank away from the trigger's borders no rounding can reach them.
void Playhead::advanceByVblanks(std::uint64_t vblanks, double triggers_per_vblank) RT_SAFE {
  const auto nearWhole = [](double value) {
    return std::abs(value - std::round(value)) <= kEvenWithin * value;
  };
  const double vblanks_per_trigger = 1 / triggers_per_vblank;
  if (vblanks_per_trigger >= 1 - kEvenWithin && nearWhole(vblanks_per_trigger)) {
    const auto whole = static_cast<std::uint64_t>(std::round(vblanks_per_trigger));
    const auto shown = static_cast<std::uint64_t>(fraction_ * static_cast<double>(whole)) + vblanks;
    trigger_ += shown / whole;
    fraction_ = (static_cast<double>(shown % whole) + 0.5) / static_cast<double>(whole);
  } else if (triggers_per_vblank > 1 && nearWhole(triggers_per_vblank)) {
    trigger_ += vblanks * static_cast<std::uint64_t>(std::round(triggers_per_vblank));
  } else {
    advanceBy(static_cast<double>(vblanks) * triggers_per_vblank);
  }
}

void Playhead::advanceBy(double triggers) RT_SAFE {
  const double sum = fraction_ + triggers;
  const double whole = std::floor(sum);
  trigger_ += static_cast<std::uint64_t>(whole);
  fraction_ = sum - whole;
}

void Playhead::keepNear(std::uint64_t wanted) RT_SAFE {
  const auto behind = static_cast<std::int64_t>(wanted - trigger_);
  if (behind > kFar_triggers || behind < -kFar_triggers) {
    seek(wanted);
  } else if (behind > 1) {
    ++trigger_;
  } else if (behind < -1) {
    trigger_ = std::max(before_, wanted + 1);
  }
}

}  // namespace appliance

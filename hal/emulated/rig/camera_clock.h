#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "rt/clock.h"

namespace emulator {

/// A camera's own clock: ticks of 1 ns that run a little fast or slow. Pure.
///
/// It started with this machine's clock, and starts again from zero with the camera.
class CameraClock {
 public:
  /// @p parts_per_million: how much faster than the true time.
  explicit CameraClock(double parts_per_million) : own_ppm_(parts_per_million) {}

  /// Never 0: that would say that the camera has no clock.
  [[nodiscard]] std::uint64_t ticks(rt::Timestamp at) const {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(elapsed(at), 1));
  }

  /// From @p now on so much faster than it runs by nature; no step.
  void drift(rt::Timestamp now, double parts_per_million) {
    ticks_at_base_ = elapsed(now);
    base_ = now;
    drift_ppm_ = parts_per_million;
  }

  /// The camera was switched on at @p now.
  void restart(rt::Timestamp now) {
    ticks_at_base_ = 0;
    base_ = now;
  }

 private:
  [[nodiscard]] std::int64_t elapsed(rt::Timestamp at) const {
    const std::int64_t ns = (at - base_).count();
    const double extra = static_cast<double>(ns) * (own_ppm_ + drift_ppm_) * 1e-6;
    return ticks_at_base_ + ns + std::llround(extra);
  }

  double own_ppm_;
  double drift_ppm_ = 0;
  rt::Timestamp base_;
  std::int64_t ticks_at_base_ = 0;
};

}  // namespace emulator

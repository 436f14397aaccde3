#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "hal/display.h"
#include "rt/clock.h"

/// A screen's vblanks with a crystal of its own and stamps that are not exact; the truth is known.
class SimulatedScreen {
 public:
  struct Crystal {
    double nominal_hz = 60;
    double off_ppm = 0;           ///< constant
    double wander_ppm = 0;        ///< and this much to both sides of it,
    double wander_period_s = 60;  ///< as slowly as temperature goes
  };

  SimulatedScreen(const Crystal& crystal, double stamp_jitter_ns, rt::Timestamp first,
                  std::uint32_t seed)
      : crystal_(crystal), first_(first), random_(seed), jitter_ns_(0, 1), rms_(stamp_jitter_ns) {}

  /// When vblank @p number truly is.
  [[nodiscard]] rt::Timestamp truly(std::uint64_t number) const {
    constexpr double kTwoPi = 6.283185307179586;
    const double t_s = static_cast<double>(number) / crystal_.nominal_hz;
    const double turn = kTwoPi * t_s / crystal_.wander_period_s;
    const double wander_s =
        crystal_.wander_ppm * 1e-6 * crystal_.wander_period_s / kTwoPi * (1 - std::cos(turn));
    const double s = t_s * (1 + crystal_.off_ppm * 1e-6) + wander_s;
    return first_ + rt::Nanoseconds(std::llround(s * 1e9));
  }

  [[nodiscard]] std::uint64_t firstAfter(rt::Timestamp t) const {
    if (t < first_) return 0;
    const auto since_ns = static_cast<double>((t - first_).count());
    auto number = static_cast<std::uint64_t>(since_ns * 1e-9 * crystal_.nominal_hz * 0.999);
    while (truly(number) <= t) ++number;
    return number;
  }

  /// As the kernel would report it.
  [[nodiscard]] hal::PageFlip flip(std::uint64_t picture_id, std::uint64_t number) {
    const rt::Nanoseconds error{std::llround(rms_ * jitter_ns_(random_))};
    return {.picture_id = picture_id, .page_flip = truly(number) + error, .vblank = number};
  }

 private:
  Crystal crystal_;
  rt::Timestamp first_;
  std::mt19937 random_;
  std::normal_distribution<double> jitter_ns_;
  double rms_;
};

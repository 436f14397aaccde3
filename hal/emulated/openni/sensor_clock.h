#pragma once

#include <cstdint>

#include "rt/clock.h"

namespace emulator {

/// The clock and the delays of an emulated depth sensor. Pure.
struct SensorClock {
  rt::Timestamp power_on;               ///< its clock begins at 0 with its power
  double drift_ppm = 35;                ///< a cheap crystal: fast by this
  rt::Nanoseconds latency{40'000'000};  ///< from exposure to the picture at the host, at least
  rt::Nanoseconds jitter{1'500'000};    ///< USB adds up to this

  /// The stamp of a picture, on the sensor's own clock.
  [[nodiscard]] std::uint64_t stamp_us(rt::Timestamp exposure) const {
    const auto since_ns = static_cast<double>((exposure - power_on).count());
    return since_ns <= 0 ? 0 : static_cast<std::uint64_t>(since_ns * (1 + drift_ppm * 1e-6) / 1e3);
  }

  /// When the host gets it; the jitter of picture @p number is always the same.
  [[nodiscard]] rt::Timestamp arrival(rt::Timestamp exposure, std::uint64_t number) const {
    const std::uint64_t mixed = (number * 0x9e3779b97f4a7c15ULL) >> 48U;
    return exposure + latency + jitter * static_cast<std::int64_t>(mixed) / 65536;
  }
};

}  // namespace emulator

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "rt/clock.h"

namespace hal {

/// One registered pair of pictures, borrowed until the next call of the sensor.
struct DepthFrame {
  std::span<const std::uint16_t> depth_mm;   ///< row-major; 0 where nothing was measured
  std::span<const std::uint8_t> colour_rgb;  ///< the same size in pixels; empty without colour
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  rt::Timestamp exposure;  ///< when the light was taken, sensor latency already removed
};

/// An RGB-D sensor that looks at the athlete.
///
/// Threads  One caller: the tracker.
/// RT       Blocks; never called from a real-time thread.
/// Errors   No frame within the timeout is nullopt; alive() tells silence from loss.
class DepthSensor {
 public:
  virtual ~DepthSensor() = default;
  [[nodiscard]] virtual std::optional<DepthFrame> waitFrame(rt::Nanoseconds timeout) = 0;
  [[nodiscard]] virtual bool alive() const = 0;
};

}  // namespace hal

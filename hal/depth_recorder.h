#pragma once

#include <expected>
#include <string>

#include "hal/depth_sensor.h"

namespace hal {

/// Writes a sensor's pictures as a recording, which plays as a sensor: backend "folder".
///
/// Threads  One caller.
/// RT       Blocks on the disk.
/// Errors   One line for a person: the place holds something already, it cannot be written, the
///          disk is full. What was written before stays.
class DepthRecorder {
 public:
  virtual ~DepthRecorder() = default;

  /// Writes one pair. The first one begins the recording. @p sensor: what the sensor calls itself.
  [[nodiscard]] virtual std::expected<void, std::string> write(const DepthFrame& frame,
                                                               const std::string& sensor) = 0;
};

}  // namespace hal

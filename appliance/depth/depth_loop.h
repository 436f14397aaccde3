#pragma once

#include <atomic>
#include <memory>
#include <stop_token>
#include <string>

#include "hal/depth_sensor.h"
#include "rt/clock.h"

namespace appliance {

/// The depth sensor as people want it told.
struct DepthReport {
  hal::DepthStatus sensor;
  double rate_hz = 0;  ///< of the pictures of the last seconds
};

/// "streaming: NAME, 640x480 with colour, 30.0 Hz; 900 pictures, 0 lost", in one line.
[[nodiscard]] std::string depthText(const DepthReport& report);

/// What is less than asked for, for a person; empty: nothing.
[[nodiscard]] std::string depthTrouble(const DepthReport& report);

/// Takes the sensor's pictures as they come.
///
/// Threads  run(): the `depth` thread. report(): any.
/// Errors   A sensor that goes is told by report(); it comes back by itself.
class DepthLoop {
 public:
  explicit DepthLoop(std::unique_ptr<hal::DepthSensor> sensor) : sensor_(std::move(sensor)) {}

  void run(const std::stop_token& stop);
  [[nodiscard]] DepthReport report() const;

 private:
  const std::unique_ptr<hal::DepthSensor> sensor_;
  std::atomic<double> rate_hz_{0};
};

}  // namespace appliance

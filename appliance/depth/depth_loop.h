#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "appliance/depth/depth_board.h"
#include "appliance/depth/depth_sight.h"
#include "hal/depth_sensor.h"
#include "rt/clock.h"

namespace appliance {

/// The depth sensor and those who read its pictures, for people.
struct DepthReport {
  hal::DepthStatus sensor;
  double rate_hz = 0;                  ///< of the pictures of the last seconds
  std::optional<rt::Nanoseconds> age;  ///< since the newest picture's exposure; none: no picture
  std::optional<DepthSight> sight;     ///< of the newest picture
  std::vector<DepthReaderStatus> readers;
};

/// Puts the sensor's pictures on the board as they come.
///
/// Threads  run(): the `depth` thread. report(): any.
/// Errors   report() says that a sensor went; it comes back by itself.
class DepthLoop {
 public:
  /// @p board outlives the loop.
  DepthLoop(std::unique_ptr<hal::DepthSensor> sensor, DepthBoard& board)
      : sensor_(std::move(sensor)), board_(board) {}

  void run(const std::stop_token& stop);
  [[nodiscard]] DepthReport report() const;

 private:
  const std::unique_ptr<hal::DepthSensor> sensor_;
  DepthBoard& board_;
  std::atomic<std::int64_t> newest_exposure_ns_{0};
  std::atomic<double> rate_hz_{0};
};

}  // namespace appliance

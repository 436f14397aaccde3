#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/depth_sensor.h"
#include "hal/openni/video_mode.h"
#include "rt/clock.h"

namespace hal::openni {

struct DeviceRequest {
  std::string source;  ///< a URI or the path of an .oni file; empty: the first sensor there is
  VideoMode mode{.width_px = 640, .height_px = 480, .rate_hz = 30};
  bool colour = true;
};

/// One pair as OpenNI2 gave it, valid until the next call.
struct DevicePair {
  std::span<const std::uint16_t> depth_mm;
  std::span<const std::uint8_t> colour_rgb;  ///< empty: none came with it
  std::uint64_t number = 0;
  std::uint64_t stamp_us = 0;
  std::uint64_t colour_stamp_us = 0;
  rt::Timestamp frame_ready;
};

/// OpenNI2 with one device open, depth registered to colour and neither mirrored.
///
/// Lives in a process of its own: drivers may block forever, crash, or lose a sensor for good.
///
/// Threads  One caller. OpenNI2's own threads fill its queues.
/// Errors   open(): one line for a person.
class Device {
 public:
  /// Whether OpenNI2 starts at all, with the drivers it finds.
  [[nodiscard]] static std::expected<void, std::string> startLibrary();
  /// Whether a device of that source is there now; a file always is.
  [[nodiscard]] static bool present(const std::string& source);

  /// What is there, a line each: URI and name.
  [[nodiscard]] static std::vector<std::string> list();

  [[nodiscard]] static std::expected<std::unique_ptr<Device>, std::string> open(
      const DeviceRequest& request);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  struct Facts {
    std::string name;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    DepthLens lens;  ///< of depth
    DepthLens colour_lens;
    bool colour = false;
    bool recording = false;
    std::vector<std::string> remarks;  ///< what is less than asked for
  };
  [[nodiscard]] const Facts& facts() const;

  enum class Answer : std::uint8_t { kPair, kNothing, kGone, kEnd };
  /// The next pair, waiting no longer than @p timeout.
  [[nodiscard]] Answer next(rt::Nanoseconds timeout, DevicePair& pair);

  /// Writes what streams from now on into an .oni file, until the device is closed.
  [[nodiscard]] std::expected<void, std::string> record(const std::string& path);

 private:
  struct Implementation;
  explicit Device(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hal::openni

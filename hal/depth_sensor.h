#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "rt/clock.h"

namespace hal {

/// Pinhole and Brown-Conrady distortion; integer coordinates are pixel centres.
struct DepthLens {
  double focal_x_px = 0, focal_y_px = 0;
  double centre_x_px = 0, centre_y_px = 0;
  /// In OpenCV's order: k1, k2, p1, p2, k3. Zeros: none, or the sensor does not report it.
  std::array<double, 5> distortion{};

  friend bool operator==(const DepthLens&, const DepthLens&) = default;
};

/// One registered pair of pictures, borrowed until the next call of the sensor.
struct DepthFrame {
  std::span<const std::uint16_t> depth_mm;  ///< row-major, along the axis; 0: nothing measured
  std::span<const std::uint8_t>
      colour_rgb;  ///< the same size in pixels, sRGB; empty without colour
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  DepthLens lens;            ///< of the depth picture; the colour camera's if depth is registered
  DepthLens colour_lens;     ///< of the colour picture
  std::uint64_t number = 0;  ///< counted by the sensor: a gap is a lost picture
  rt::Timestamp exposure;    ///< when depth's light was taken: clock fitted, latency removed
  rt::Timestamp colour_exposure;  ///< when colour's light was taken; the epoch without colour
  rt::Timestamp frame_ready;      ///< both arrived on this machine
};

enum class DepthState : std::uint8_t {
  kConnecting,  ///< looked for; never seen yet
  kStreaming,
  kLost,   ///< was there; looked for all the time
  kEnded,  ///< a recording came to its end
};

struct DepthStatus {
  DepthState state = DepthState::kConnecting;
  std::string name;     ///< what the sensor calls itself, or the recording's path
  std::string message;  ///< what is less than asked for and what to do; empty: nothing
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  bool colour = false;
  std::uint64_t frames = 0;          ///< delivered
  std::uint64_t lost = 0;            ///< numbers that never came, since it was first connected
  std::uint64_t without_colour = 0;  ///< delivered, but colour should have come and did not
  std::uint64_t returns = 0;         ///< how often it came back after it was lost
  double drift_ppm = 0;              ///< how much faster than ours its clock runs
};

/// What a sensor or a recording is opened with.
struct DepthSensorSettings {
  std::string source;   ///< "openni": URI or .oni file, empty: the first sensor; "folder": its path
  std::string drivers;  ///< "openni": folder of OpenNI2 drivers; empty: the system's
  std::uint32_t width_px = 640;
  std::uint32_t height_px = 480;
  std::uint32_t rate_hz = 30;
  bool colour = true;
  rt::Nanoseconds latency =
      std::chrono::milliseconds(40);  ///< of a sensor: from exposure to arrival
  bool repeat = true;                 ///< a recording begins again at its end
  bool operator==(const DepthSensorSettings&) const = default;
};

/// An RGB-D sensor that looks at the athlete, or a recording of one.
///
/// The sensor supervises itself while its caller waits: if the device disappears, the sensor
/// searches for it and continues with the same settings.
///
/// Threads  One caller: the depth loop, which copies each pair for all readers. status(): any.
/// RT       Blocks; never called from a real-time thread.
/// Errors   No frame within the timeout is nullopt; status() distinguishes silence, loss and end.
class DepthSensor {
 public:
  virtual ~DepthSensor() = default;
  /// The next pair, oldest first.
  [[nodiscard]] virtual std::optional<DepthFrame> waitFrame(rt::Nanoseconds timeout) = 0;
  [[nodiscard]] virtual DepthStatus status() const = 0;
};

}  // namespace hal

#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "rt/clock.h"

namespace emulator {

/// Where writer and driver meet unless the environment variable KAGAMI_DEPTH_RING says otherwise.
[[nodiscard]] std::string depthRingPath();

/// What the pictures of one ring have in common: an ideal pinhole with square pixels, colour and
/// depth seen from the same point. Integer coordinates are pixel centres.
struct RgbdFormat {
  std::uint32_t width_px = 640;
  std::uint32_t height_px = 480;
  double rate_hz = 30;
  double focal_px = 570;
  double centre_x_px = 319.5;
  double centre_y_px = 239.5;
  bool colour = true;  ///< false: the sensor has no colour camera
  [[nodiscard]] std::size_t pixels() const { return std::size_t{width_px} * height_px; }
};

/// Perfect RGB-D pictures for the emulated depth sensor, handed from one process to another: a file
/// in shared memory with a few slots, the oldest overwritten. The driver adds what a sensor does to
/// them: noise, holes, quantisation, latency and its own clock.
///
/// A picture is delivered when its exposure and the sensor's latency have passed, so the writer may
/// draw ahead, by half of the slots; one that comes later is delivered immediately. The
/// sensor is plugged in while the writer lives and says so.
///
/// Threads  One writer in all; each object: one caller, setPlugged() any thread.
/// RT       publish() wakes the reader by one system call; drawing happens in the slot itself.
/// Memory   slots x (4 + 3) bytes a pixel in /dev/shm: 17 MB at 640 x 480.
class DepthRingWriter {
 public:
  static constexpr std::uint32_t kSlots = 8;

  /// One slot to draw into, row-major, valid until publish().
  struct Canvas {
    std::span<float> depth_m;            ///< along the optical axis; 0: nothing there
    std::span<std::uint8_t> colour_rgb;  ///< sRGB; empty without colour
  };

  /// Errors  The place cannot be written, or another writer lives there.
  [[nodiscard]] static std::expected<DepthRingWriter, std::string> create(const std::string& path,
                                                                          const RgbdFormat& format);
  DepthRingWriter(DepthRingWriter&& other) noexcept;
  DepthRingWriter& operator=(DepthRingWriter&& other) noexcept;
  ~DepthRingWriter();

  /// The slot of the next picture; its old contents are gone.
  [[nodiscard]] Canvas begin();
  /// Hands out what was drawn; pictures are numbered from 1 in the order of their exposures.
  std::uint64_t publish(rt::Timestamp exposure);

  void setPlugged(bool plugged);

 private:
  struct Mapping;
  explicit DepthRingWriter(std::unique_ptr<Mapping> mapping);
  std::unique_ptr<Mapping> mapping_;
  std::uint64_t number_ = 0;
};

/// The driver's end.
class DepthRingReader {
 public:
  struct Stamp {
    std::uint64_t number = 0;
    rt::Timestamp exposure;
  };

  /// Errors  No ring, or none that this version reads.
  [[nodiscard]] static std::expected<DepthRingReader, std::string> open(const std::string& path);
  DepthRingReader(DepthRingReader&& other) noexcept;
  DepthRingReader& operator=(DepthRingReader&& other) noexcept;
  ~DepthRingReader();

  [[nodiscard]] const RgbdFormat& format() const;
  [[nodiscard]] std::uint64_t newest() const;  ///< 0: none yet
  /// The writer lives and has its sensor plugged in.
  [[nodiscard]] bool plugged() const;

  /// Waits until there is a picture after @p number, or the time is over.
  void waitAfter(std::uint64_t number, rt::Nanoseconds timeout) const;
  /// None: overwritten, or not there yet.
  [[nodiscard]] std::optional<Stamp> stamp(std::uint64_t number) const;
  /// Copies picture @p number; false: it was overwritten meanwhile. Without colour @p colour_rgb is
  /// left as it is.
  [[nodiscard]] bool read(std::uint64_t number, std::span<float> depth_m,
                          std::span<std::uint8_t> colour_rgb) const;

 private:
  struct Mapping;
  explicit DepthRingReader(std::unique_ptr<Mapping> mapping);
  std::unique_ptr<Mapping> mapping_;
};

}  // namespace emulator

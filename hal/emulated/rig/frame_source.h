#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/emulated/rig/scene.h"

namespace emulator {

/// The part of the sensor that leaves the camera, and as what.
struct Region {
  SizePx sensor;
  std::uint32_t offset_x_px = 0;
  std::uint32_t offset_y_px = 0;
  SizePx size;
  std::uint32_t pixel_format = 0;

  friend bool operator==(const Region&, const Region&) = default;
};

/// Turns what the scene shows into the frame that the registers ask for. The whole sensor as
/// BayerRG8, the case that must be fast, passes through untouched; a smaller region is copied;
/// Mono8 is the mean of each pixel's 2x2 neighbourhood.
class FrameSource {
 public:
  FrameSource(Scene& scene, std::uint32_t camera) : scene_(scene), camera_(camera) {}

  /// Gets the memory that @p region needs.
  void prepare(const Region& region);
  /// See Scene::expose() for the life of the pixels.
  [[nodiscard]] gvsp::Picture expose(std::uint64_t trigger, std::uint32_t slot);

 private:
  [[nodiscard]] bool passesThrough() const;

  Scene& scene_;
  std::uint32_t camera_;
  Region region_;
  std::vector<std::uint8_t> sensor_;
  std::array<std::vector<std::uint8_t>, kFrameHistory> slots_;
};

}  // namespace emulator

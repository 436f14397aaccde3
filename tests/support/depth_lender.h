#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/depth_sensor.h"
#include "rt/clock.h"

namespace test {

/// A sensor that lends the same memory again and again, as hal::DepthSensor does.
class DepthLender {
 public:
  explicit DepthLender(std::uint32_t width_px = 8, std::uint32_t height_px = 4)
      : width_px_(width_px),
        height_px_(height_px),
        depth_mm_(std::size_t{width_px} * height_px),
        colour_rgb_(3 * depth_mm_.size()) {}

  hal::DepthFrame lend(std::uint64_t number, bool colour = true) {
    std::ranges::fill(depth_mm_, static_cast<std::uint16_t>(number));
    std::ranges::fill(colour_rgb_, static_cast<std::uint8_t>(number));
    return {.depth_mm = depth_mm_,
            .colour_rgb = colour ? colour_rgb_ : std::span<const std::uint8_t>{},
            .width_px = width_px_,
            .height_px = height_px_,
            .lens = {.focal_x_px = 570, .focal_y_px = 570},
            .colour_lens = {.focal_x_px = 580, .distortion = {0.1, 0, 0, 0, 0}},
            .number = number,
            .exposure = rt::fromNs(1000 * static_cast<std::int64_t>(number)),
            .colour_exposure = rt::fromNs(1000 * static_cast<std::int64_t>(number) + 7)};
  }

 private:
  std::uint32_t width_px_;
  std::uint32_t height_px_;
  std::vector<std::uint16_t> depth_mm_;
  std::vector<std::uint8_t> colour_rgb_;
};

}  // namespace test

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "appliance/depth/depth_reader.h"

namespace appliance {

/// What a depth picture holds, in two figures: enough to see whether the sensor is aimed well.
struct DepthSight {
  double measured_share = 0;       ///< of the pixels, 0 to 1
  std::optional<double> middle_m;  ///< median distance around the picture's centre
};

/// Looks at every eighth pixel, and at all around the centre. Pure.
[[nodiscard]] DepthSight sightOf(std::span<const std::uint16_t> depth_mm, std::uint32_t width_px,
                                 std::uint32_t height_px);

/// The sight of the newest picture, as a reader of the depth board.
///
/// Threads  One caller.
class DepthSightReader {
 public:
  /// @p reader has a budget of one pin.
  explicit DepthSightReader(DepthReader& reader) : reader_(reader) {}

  /// None: no picture came yet.
  [[nodiscard]] const std::optional<DepthSight>& look() {
    if (const auto pinned = reader_.tryNewest())
      sight_ = sightOf(pinned->depth_mm, pinned->picture.width_px, pinned->picture.height_px);
    return sight_;
  }

 private:
  DepthReader& reader_;
  std::optional<DepthSight> sight_;
};

}  // namespace appliance

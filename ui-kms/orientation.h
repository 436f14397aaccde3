#pragma once

#include <array>
#include <cstdint>

#include "hal/scene.h"

namespace ui {

struct SizePx {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  friend bool operator==(const SizePx&, const SizePx&) = default;
};

/// How the screen hangs, and where a pixel of the upright picture lies in the memory that it scans
/// out. Turned by 90 degrees, the screen's own top edge is on its viewer's right.
class Orientation {
 public:
  Orientation() = default;
  /// @p rotation_deg: clockwise as the viewer sees it; a multiple of 90.
  explicit constexpr Orientation(std::uint32_t rotation_deg) : quarters_(rotation_deg / 90 % 4) {}

  [[nodiscard]] constexpr bool upright() const { return quarters_ == 0; }
  /// Of the picture for a screen of @p size, and the other way round.
  [[nodiscard]] constexpr SizePx turned(SizePx size) const {
    return quarters_ % 2 == 0 ? size : SizePx{size.height, size.width};
  }
  /// From the picture to the screen, both from -1 to 1, y down.
  [[nodiscard]] constexpr std::array<float, 2> turned(float x, float y) const {
    switch (quarters_) {
      case 1:
        return {y, -x};
      case 2:
        return {-x, -y};
      case 3:
        return {-y, x};
      default:
        return {x, y};
    }
  }
  /// @p where lies in a picture of @p picture.
  [[nodiscard]] constexpr hal::RectPx turned(const hal::RectPx& where, SizePx picture) const {
    const auto width = static_cast<std::int32_t>(picture.width);
    const auto height = static_cast<std::int32_t>(picture.height);
    const std::int32_t right = where.x + where.width;
    const std::int32_t bottom = where.y + where.height;
    switch (quarters_) {
      case 1:
        return {where.y, width - right, where.height, where.width};
      case 2:
        return {width - right, height - bottom, where.width, where.height};
      case 3:
        return {height - bottom, where.x, where.height, where.width};
      default:
        return where;
    }
  }

 private:
  std::uint32_t quarters_ = 0;
};

}  // namespace ui

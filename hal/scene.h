#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

#include "hal/overlay.h"
#include "hal/warp_plan.h"

namespace hal {

/// Pixels [x, x + width) by [y, y + height) of the picture, y down.
struct RectPx {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t width = 0;
  std::int32_t height = 0;

  [[nodiscard]] constexpr bool empty() const { return width <= 0 || height <= 0; }
  friend constexpr bool operator==(const RectPx&, const RectPx&) = default;
};

/// What lies in both; empty where nothing does.
[[nodiscard]] constexpr RectPx common(const RectPx& a, const RectPx& b) {
  const std::int32_t x = std::max(a.x, b.x);
  const std::int32_t y = std::max(a.y, b.y);
  return {x, y, std::min(a.x + a.width, b.x + b.width) - x,
          std::min(a.y + a.height, b.y + b.height) - y};
}

/// Larger than any picture.
inline constexpr RectPx kWholePicture{0, 0, 65535, 65535};

/// One view in the picture.
struct ViewLayer {
  WarpPlan plan;                 ///< for the whole picture, whatever part of it is drawn
  RectPx where = kWholePicture;  ///< nothing is drawn outside it, or outside the picture
  float opacity = 1;             ///< 0 to 1: how much it hides of the layers below, in linear light
  /// Names the frame, so that one which was drawn before is not loaded again: equal numbers mean
  /// equal pixels. 0: no name; the frame is loaded each time.
  std::uint64_t content = 0;
};

/// The name of a stored frame as a layer's content.
[[nodiscard]] constexpr std::uint64_t contentOf(std::uint32_t camera, std::uint64_t trigger) {
  return (std::uint64_t{camera} + 1) << 48U | trigger;
}

/// One picture: what a display draws. Pure data; the sources are borrowed for the render() call.
struct Scene {
  static constexpr std::uint32_t kMostLayers = 4;
  std::array<ViewLayer, kMostLayers> layers{};  ///< the lowest first
  std::uint32_t count = 0;                      ///< of layers; with none the picture is empty
  const Overlay* overlay = nullptr;             ///< over the views; borrowed like them; none: bare
};
static_assert(std::is_trivially_copyable_v<Scene>);

}  // namespace hal

#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "hal/warp_plan.h"

namespace hal {

/// The line of text over the picture. Trivially copyable; utf-8, zero-terminated.
struct StatusLine {
  std::array<char, 128> text{};
  bool warning = false;  ///< drawn as a badge: the picture is not what was asked for
  [[nodiscard]] std::string_view view() const { return text.data(); }
};

/// One view in the picture.
struct ViewLayer {
  WarpPlan plan;
};

/// One picture: what a display draws. Pure data; the sources are borrowed for the render() call.
struct Scene {
  static constexpr std::uint32_t kMostLayers = 1;
  std::array<ViewLayer, kMostLayers> layers{};
  std::uint32_t count = 0;  ///< of layers; with none the picture is empty
  StatusLine status;
};
static_assert(std::is_trivially_copyable_v<Scene>);

}  // namespace hal

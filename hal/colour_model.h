#pragma once

#include <array>
#include <type_traits>

namespace hal {

/// From one camera's raw values to the linear light that all cameras of a rig share. The members
/// stand in the order in which they act on each pixel; the defaults change nothing.
struct ColourModel {
  /// The raw value of a pixel that got no light, in 8-bit codes. It becomes 0, and 255 stays white.
  float black_level = 0;
  /// How the brightness falls off from the optical axis: 1 + v[0] r^2 + v[1] r^4 + v[2] r^6 of what
  /// it is there, r in halves of the picture's diagonal.
  std::array<float, 3> vignetting{};
  std::array<float, 3> gain_rgb{1, 1, 1};
  /// Row-major, from the camera's red, green, blue to linear sRGB.
  std::array<float, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};

  friend bool operator==(const ColourModel&, const ColourModel&) = default;
};
static_assert(std::is_trivially_copyable_v<ColourModel>);

}  // namespace hal

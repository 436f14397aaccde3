#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace hal {

/// How far a picture may reach from the display's centre. Beyond it the surround is shown, with a
/// soft edge between them.
///
/// The display's edge has kPlaces places, clockwise from the top left corner, kPlacesPerSide of
/// them evenly along each side. A place's narrowing n says that the picture reaches 1 / n of the
/// way from the centre to it. Between two places n is interpolated, so a straight edge of the
/// picture stays straight.
///
/// Units  Points of the display are (u, v): -1 is its left and upper edge, 1 its right and lower.
struct EdgeMask {
  static constexpr std::size_t kPlacesPerSide = 16;
  static constexpr std::size_t kPlaces = 4 * kPlacesPerSide;
  /// The soft edge's part of the way from the centre to the end of the picture.
  static constexpr float kFeather = 0.02F;
  /// A place of this narrowing shows the picture at full strength.
  static constexpr float kNone = 1 - kFeather;

  std::array<float, kPlaces> narrowing = everywhere(kNone);

  [[nodiscard]] static constexpr std::array<float, kPlaces> everywhere(float value) {
    std::array<float, kPlaces> all{};
    all.fill(value);
    return all;
  }

  /// Where @p place is on the display's edge.
  [[nodiscard]] static constexpr std::array<double, 2> pointOf(std::size_t place) {
    const double along = 2.0 * static_cast<double>(place % kPlacesPerSide) / kPlacesPerSide - 1;
    switch (place / kPlacesPerSide) {
      case 0:
        return {along, -1};
      case 1:
        return {1, along};
      case 2:
        return {-along, 1};
      default:
        return {-1, -along};
    }
  }

  /// How far out (u, v) lies: 0 is the centre, 1 the end of the picture.
  [[nodiscard]] double at(double u, double v) const {
    const double out = std::max(std::abs(u), std::abs(v));
    if (!(out > 0)) return 0;
    const bool upright = std::abs(v) >= std::abs(u);
    const double side = upright ? (v < 0 ? 0 : 2) : (u > 0 ? 1 : 3);
    const double along = (upright ? (v < 0 ? u : -u) : (u > 0 ? v : -v)) / out;
    const double place = (side + (along + 1) / 2) * kPlacesPerSide;
    const auto before = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(before);
    return out *
           ((1 - part) * narrowing[before % kPlaces] + part * narrowing[(before + 1) % kPlaces]);
  }

  /// Whether any of the display is not shown at full strength.
  [[nodiscard]] bool active() const { return std::ranges::max(narrowing) > kNone; }

  friend bool operator==(const EdgeMask&, const EdgeMask&) = default;
};
static_assert(std::is_trivially_copyable_v<EdgeMask>);

}  // namespace hal

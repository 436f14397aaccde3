#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "appliance/director/stored_views.h"
#include "rt/annotations.h"

namespace appliance {

struct Rig;

/// The cameras in the order in which the view passes them, each at its true angle around the
/// target. Angles count from the first camera of the order and grow along it; they grow with the
/// cameras' numbers where these follow the arc at all. A closed ring is cut at its widest gap.
///
/// RT       Trivially copyable; every member is RT safe.
/// Units    Degrees.
class ArcPath {
 public:
  ArcPath() = default;

  /// @p azimuths_deg: of each camera about the target, in any turn; kMostViews at most count.
  explicit ArcPath(std::span<const double> azimuths_deg) RT_SAFE;

  /// Without a rig: one degree from camera to camera.
  [[nodiscard]] static ArcPath even(std::uint32_t cameras) RT_SAFE;

  [[nodiscard]] std::uint32_t cameras() const RT_SAFE { return count_; }
  [[nodiscard]] double angleOf(std::uint32_t camera) const RT_SAFE;
  [[nodiscard]] double length_deg() const RT_SAFE;
  /// From one camera to the next on average; 0 for a single one.
  [[nodiscard]] double meanStep_deg() const RT_SAFE;

  /// The cameras on both sides of an angle and how far it is from left to right, 0 to 1. Beyond an
  /// end both are that end's.
  struct Place {
    std::uint32_t left = 0;
    std::uint32_t right = 0;
    double mix = 0;
  };
  [[nodiscard]] Place at(double angle_deg) const RT_SAFE;

  /// The camera nearest to an angle among those that are usable; of two equally near ones the one
  /// that comes first in the order.
  template <class Usable>
  [[nodiscard]] std::optional<std::uint32_t> nearest(double angle_deg,
                                                     Usable usable) const RT_SAFE {
    std::optional<std::uint32_t> best;
    double best_away = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const double away = stops_[i].angle_deg < angle_deg ? angle_deg - stops_[i].angle_deg
                                                          : stops_[i].angle_deg - angle_deg;
      if ((best && away >= best_away) || !usable(stops_[i].camera)) continue;
      best = stops_[i].camera;
      best_away = away;
    }
    return best;
  }

 private:
  struct Stop {
    double angle_deg = 0;
    std::uint32_t camera = 0;
  };
  std::array<Stop, kMostViews> stops_{};  // the first count_, with rising angles
  std::uint32_t count_ = 0;
};

/// The path of a rig's cameras around its target.
[[nodiscard]] ArcPath arcOf(const Rig& rig) RT_SAFE;

}  // namespace appliance

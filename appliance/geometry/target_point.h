#pragma once

#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "rt/annotations.h"

namespace appliance {

/// A point of the rig frame. Trivially copyable.
struct TargetPoint {
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;

  friend bool operator==(const TargetPoint&, const TargetPoint&) = default;

  [[nodiscard]] Eigen::Vector3d vector() const { return {x_m, y_m, z_m}; }
};

/// How the target of an instant is known.
enum class TargetOrigin : std::uint8_t {
  kRig,        ///< nothing is known of that instant: the rig's own point
  kMeasured,   ///< lies between two measurements close to each other
  kPredicted,  ///< lies after the newest measurement, or in a gap between two
  kByHand,     ///< a person set it
};

/// For people: "the rig's", "measured", "predicted", "set by hand".
[[nodiscard]] std::string_view nameOf(TargetOrigin origin);

/// Where the target was at one instant. Trivially copyable.
struct Target {
  TargetPoint point;
  TargetOrigin origin = TargetOrigin::kRig;
  double confidence = 0;       ///< 0: nothing supports it; 1: sure
  std::uint64_t revision = 0;  ///< grows, within one origin, whenever what it rests on changed
};

/// Whether a picture that shows @p shown must be drawn again because the target of the same
/// instant is @p now. Measurements are smoothed afterwards: their revisions count only beyond a
/// dead band of 5 mm. A point that a person set counts to the last digit.
[[nodiscard]] bool looksDifferent(const Target& shown, const Target& now) RT_SAFE;

}  // namespace appliance

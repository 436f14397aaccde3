#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace emulator::studio {

/// What the mains do to the lamps: 50 Hz, so the light ripples at twice that.
inline constexpr double kRipple_hz = 100;
/// How far a lamp's light swings about its mean.
inline constexpr float kRippleDepth = 0.14f;

/// A flat rectangle that shines to the side of its normal, alike in every direction seen from the
/// front (Lambert). Radiance is in units in which a white wall in good light sends out about 1.
struct Lamp {
  Eigen::Vector3f centre;  ///< metres, rig frame
  Eigen::Vector3f half_u;
  Eigen::Vector3f half_v;
  Eigen::Vector3f normal;
  Eigen::Vector3f radiance;
  float phase = 0;  ///< of its ripple, radians
  bool ripples = true;

  /// Light output at @p seconds of the scene's time over its mean.
  [[nodiscard]] float ripple(double seconds) const;
};

/// Rows of lamps under the ceiling, unevenly old, one of them dead, on the three phases of the
/// mains, and daylight in the window band; the first kKeyLamps hang nearest to the athlete.
inline constexpr std::size_t kKeyLamps = 6;
[[nodiscard]] std::vector<Lamp> hallLamps(std::uint64_t seed);

}  // namespace emulator::studio

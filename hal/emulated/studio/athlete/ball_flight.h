#pragma once

#include <Eigen/Core>

namespace emulator::studio {

/// A ball in the air: gravity, and bounces on the floor z = 0 that keep half of its speed.
/// Metres, seconds.
struct BallFlight {
  double from = 0;  ///< when it leaves
  double to = 0;    ///< when it is out of sight or caught
  Eigen::Vector3d start{0, 0, 0};
  Eigen::Vector3d velocity{0, 0, 0};
  double radius_m = 0.093;

  [[nodiscard]] Eigen::Vector3d at(double t) const;
};

/// The flight that starts at @p start and is at @p end after @p seconds.
[[nodiscard]] Eigen::Vector3d launchVelocity(const Eigen::Vector3d& start,
                                             const Eigen::Vector3d& end, double seconds);

}  // namespace emulator::studio

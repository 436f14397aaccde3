#include "hal/emulated/studio/athlete/ball_flight.h"

#include <cmath>

namespace emulator::studio {
namespace {

constexpr double kGravity = 9.81;
constexpr double kRestitution = 0.55;

}  // namespace

Eigen::Vector3d BallFlight::at(double t) const {
  Eigen::Vector3d p = start;
  Eigen::Vector3d v = velocity;
  double left = t - from;
  for (int bounce = 0; bounce < 6; ++bounce) {
    const double drop = p.z() - radius_m;
    const double hit =
        (v.z() + std::sqrt(std::max(v.z() * v.z() + 2 * kGravity * drop, 0.0))) / kGravity;
    if (left < hit) {
      p += v * left;
      p.z() -= 0.5 * kGravity * left * left;
      return p;
    }
    p += v * hit;
    p.z() = radius_m;
    v = {v.x() * 0.8, v.y() * 0.8, kRestitution * (kGravity * hit - v.z())};
    left -= hit;
  }
  p += Eigen::Vector3d{v.x(), v.y(), 0} * left;  // it rolls
  return p;
}

Eigen::Vector3d launchVelocity(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                               double seconds) {
  Eigen::Vector3d v = (end - start) / seconds;
  v.z() += 0.5 * kGravity * seconds;
  return v;
}

}  // namespace emulator::studio

#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "appliance/geometry/homography.h"
#include "appliance/geometry/lens.h"
#include "appliance/geometry/rig.h"
#include "tests/property/any_value.h"

namespace geometry_test {

using property_test::anyIn;

/// A number of [lowest, highest] that shrinks towards lowest.
inline double between(double lowest, double highest) {
  constexpr int kSteps = 1'000'000;
  return lowest + (highest - lowest) * anyIn(0, kSteps + 1) / kSteps;
}

inline Eigen::Vector3d pointWithin(double half_side_m) {
  const double x = between(-half_side_m, half_side_m);
  const double y = between(-half_side_m, half_side_m);
  return {x, y, between(-half_side_m, half_side_m)};
}

/// A camera somewhere around @p target_m that has it within 40 degrees of its axis, at any roll.
inline appliance::RigCamera randomCamera(const Eigen::Vector3d& target_m) {
  appliance::RigCamera camera;
  camera.width_px = anyIn(200U, 4000U);
  camera.height_px = anyIn(200U, 4000U);
  const double f = between(0.4, 4) * camera.width_px;
  camera.lens = {.fx_px = f,
                 .fy_px = f * between(0.9, 1.1),
                 .cx_px = camera.width_px * between(0.3, 0.7),
                 .cy_px = camera.height_px * between(0.3, 0.7),
                 .distortion = {between(-0.15, 0.05), between(-0.02, 0.05), between(-0.002, 0.002),
                                between(-0.002, 0.002), between(-0.01, 0.01)}};
  camera.lens.max_radius = appliance::maxRadius(camera.lens, camera.width_px, camera.height_px);

  // Never straight above or below: there "up" has no direction in the picture.
  const double azimuth = between(0, 6.28);
  const double elevation = between(-1.3, 1.3);
  const Eigen::Vector3d sight{std::cos(azimuth) * std::cos(elevation),
                              std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
  Eigen::Matrix3d level;
  level.row(0) = sight.cross(Eigen::Vector3d::UnitZ()).normalized();
  level.row(1) = sight.cross(level.row(0).transpose());
  level.row(2) = sight;
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  camera.R_cam_rig = AngleAxisd(between(-3.1, 3.1), Vector3d::UnitZ()).toRotationMatrix() *
                     AngleAxisd(between(-0.5, 0.5), Vector3d::UnitY()).toRotationMatrix() *
                     AngleAxisd(between(-0.5, 0.5), Vector3d::UnitX()).toRotationMatrix() * level;
  const Vector3d centre_m = target_m - between(0.5, 30) * sight;
  camera.t_cam_rig_m = -(camera.R_cam_rig * centre_m);
  return camera;
}

struct Scene {
  appliance::Rig rig;
  Eigen::Vector3d target_m;  ///< what is looked at: not always the rig's working point
  appliance::ViewParameters parameters;
};

inline Scene randomScene() {
  Scene scene;
  scene.target_m = pointWithin(10);
  const int cameras = anyIn(1, 21);
  for (int i = 0; i < cameras; ++i) scene.rig.cameras.push_back(randomCamera(scene.target_m));
  scene.rig.target_m = scene.target_m + pointWithin(1);
  appliance::fillReferences(scene.rig);
  scene.parameters = {
      .width_px = anyIn(64U, 4000U), .height_px = anyIn(64U, 3000U), .zoom = between(0.2, 5)};
  return scene;
}

}  // namespace geometry_test

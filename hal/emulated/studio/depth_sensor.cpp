#include "hal/emulated/studio/depth_sensor.h"

#include <Eigen/Geometry>

#include "hal/emulated/studio/random.h"

namespace emulator::studio {

using Eigen::Vector3d;

StudioCamera makeDepthSensor(std::uint64_t seed) {
  const RgbdFormat format = depthSensorFormat();
  Random random(seed * 977 + 13);
  const auto off = [&random](double most) { return most * (2 * random.unit() - 1); };
  const Vector3d centre(off(0.05), -4.0 + off(0.05), 1.7 + off(0.03));
  const Vector3d aim(off(0.05), off(0.05), 1.0 + off(0.05));
  const Vector3d forward = (aim - centre).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d level;
  level.row(0) = right;
  level.row(1) = forward.cross(right);
  level.row(2) = forward;
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(off(0.01), Vector3d::UnitZ()).toRotationMatrix() * level;
  const Vector3d translation = -rotation * centre;

  StudioCamera camera;
  camera.model.name = "depth";
  camera.model.image_size = {format.width_px, format.height_px};
  camera.model.focal_px = {format.focal_px, format.focal_px};
  camera.model.centre_px = {format.centre_x_px, format.centre_y_px};
  camera.model.distortion = {0, 0, 0, 0, 0};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      camera.model.rotation[row][column] =
          rotation(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    }
    camera.model.translation_m[row] = translation[static_cast<Eigen::Index>(row)];
  }
  return camera;
}

RgbdFormat depthSensorFormat() {
  return {.width_px = 640,
          .height_px = 480,
          .rate_hz = kDepth_hz,
          .focal_px = 380,
          .centre_x_px = 319.5,
          .centre_y_px = 239.5};
}

}  // namespace emulator::studio

#include "hal/emulated/studio/studio_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <Eigen/Geometry>

#include "hal/emulated/studio/random.h"

namespace emulator::studio {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kArc = 110 * std::numbers::pi / 180;
constexpr std::uint32_t kUsualCameras = 20;
constexpr double kRadius_m = 4.0;
constexpr double kHeight_m = 1.2;
const Vector3d kTarget_m(0, 0, 1.05);
constexpr double kFocalPerWidth = 1180.0 / 1280;
/// What colour filters and silicon make of the hall's lamps.
constexpr std::array<double, 3> kResponse = {0.74, 1.0, 0.80};

Matrix3d lookAt(const Vector3d& centre, const Vector3d& aim, double roll) {
  const Vector3d forward = (aim - centre).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Matrix3d level;
  level.row(0) = right;
  level.row(1) = forward.cross(right);
  level.row(2) = forward;
  return Eigen::AngleAxisd(roll, Vector3d::UnitZ()).toRotationMatrix() * level;
}

/// Near to normal, cut off at two deviations: no installer hangs a camera half a metre off.
double off(Random& random, double deviation) {
  return deviation * std::clamp(random.normal(), -2.0, 2.0);
}

}  // namespace

Matrix3d StudioCamera::rotation() const {
  Matrix3d r;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      r(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = model.rotation[i][k];
  }
  return r;
}

Vector3d StudioCamera::centre() const {
  return -rotation().transpose() * Vector3d(model.translation_m.data());
}

double StudioCamera::falloff(double x_px, double y_px) const {
  const double half_diagonal = 0.5 * std::hypot(model.image_size.width, model.image_size.height);
  const double r = std::hypot(x_px - model.centre_px[0], y_px - model.centre_px[1]) / half_diagonal;
  return 1 - vignetting * r * r * (0.7 + 0.3 * r * r);
}

Vector2d StudioCamera::project(const Vector3d& point_rig_m) const {
  const Vector3d p = rotation() * point_rig_m + Vector3d(model.translation_m.data());
  const double x = p.x() / p.z();
  const double y = p.y() / p.z();
  const auto& [k1, k2, p1, p2, k3] = model.distortion;
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {model.focal_px[0] * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) +
              model.centre_px[0],
          model.focal_px[1] * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) +
              model.centre_px[1]};
}

RigModel StudioRig::model() const {
  RigModel rig{.name = "studio arc",
               .target_m = {kTarget_m.x(), kTarget_m.y(), kTarget_m.z()},
               .cameras = {}};
  for (const StudioCamera& camera : cameras) rig.cameras.push_back(camera.model);
  return rig;
}

StudioRig makeStudioRig(std::uint32_t cameras, SizePx size, std::uint64_t seed) {
  StudioRig rig;
  const double step = kArc / (std::max(cameras, kUsualCameras) - 1);
  for (std::uint32_t i = 0; i < cameras; ++i) {
    Random random(seed * 977 + 31 * i + 5);
    const double angle = (i - (cameras - 1) * 0.5) * step + off(random, 0.004);
    const double radius = kRadius_m + off(random, 0.03);
    const Vector3d centre(radius * std::sin(angle), -radius * std::cos(angle),
                          kHeight_m + off(random, 0.012));
    const Vector3d aim =
        kTarget_m + Vector3d(off(random, 0.03), off(random, 0.03), off(random, 0.025));
    const double roll = off(random, 0.005);
    const double focal = kFocalPerWidth * size.width * (1 + off(random, 0.006));
    const double width = size.width;
    const double height = size.height;

    StudioCamera camera;
    char name[16];
    std::snprintf(name, sizeof name, "cam%02u", i + 1);
    camera.model.name = name;
    camera.model.image_size = size;
    camera.model.focal_px = {focal, focal * (1 + off(random, 0.0004))};
    camera.model.centre_px = {(width - 1) * 0.5 + off(random, 0.004 * width),
                              (height - 1) * 0.5 + off(random, 0.004 * height)};
    camera.model.distortion = {-0.095 + off(random, 0.008), 0.045 + off(random, 0.005),
                               off(random, 2e-4), off(random, 2e-4), 0};
    const Matrix3d rotation = lookAt(centre, aim, roll);
    const Vector3d translation = -rotation * centre;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        camera.model.rotation[row][column] =
            rotation(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
      }
      camera.model.translation_m[row] = translation[static_cast<Eigen::Index>(row)];
    }
    const double gain = 1 + off(random, 0.035);
    for (std::size_t c = 0; c < 3; ++c) {
      camera.response[c] = kResponse[c] * gain * (1 + (c == 1 ? 0 : off(random, 0.02)));
      camera.model.gain_rgb[c] = 1 / camera.response[c];
    }
    camera.vignetting = std::clamp(0.26 + off(random, 0.05), 0.1, 0.4);
    camera.read_noise_dn = std::clamp(0.75 + off(random, 0.15), 0.3, 1.2);
    rig.cameras.push_back(camera);
  }
  return rig;
}

}  // namespace emulator::studio

#include "hal/emulated/rig/arc_rig.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace emulator {
namespace {

constexpr double kArc = 110 * std::numbers::pi / 180;
constexpr std::uint32_t kUsualCameras = 20;
constexpr double kRadius_m = 4.0;
constexpr double kHeight_m = 1.2;
constexpr std::array<double, 3> kTarget_m = {0, 0, 1};
constexpr double kFocalPerWidth = 1180.0 / 1280;

using Vector = std::array<double, 3>;

Vector unit(const Vector& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Uniform in [-1, 1]; the standard distributions differ between libraries, this does not.
double scatter(std::mt19937& engine) {
  return static_cast<double>(engine()) / 2147483647.5 - 1;
}

/// Axes of a camera at @p centre that looks at @p aim, rolled about its axis.
std::array<Vector, 3> lookAt(const Vector& centre, const Vector& aim, double roll) {
  const Vector forward = unit({aim[0] - centre[0], aim[1] - centre[1], aim[2] - centre[2]});
  const Vector right = unit(cross(forward, {0, 0, 1}));
  const Vector down = cross(forward, right);
  std::array<Vector, 3> rotation{};
  for (std::size_t i = 0; i < 3; ++i) {
    rotation[0][i] = std::cos(roll) * right[i] + std::sin(roll) * down[i];
    rotation[1][i] = -std::sin(roll) * right[i] + std::cos(roll) * down[i];
    rotation[2][i] = forward[i];
  }
  return rotation;
}

}  // namespace

RigModel makeArcRig(std::uint32_t cameras, SizePx size) {
  RigModel rig{.name = "stamp arc", .target_m = kTarget_m, .cameras = {}};
  const double step = kArc / (std::max(cameras, kUsualCameras) - 1);
  for (std::uint32_t i = 0; i < cameras; ++i) {
    std::mt19937 engine(1000 + i);
    const double angle = (i - (cameras - 1) * 0.5) * step;
    const double radius = kRadius_m + 0.05 * scatter(engine);
    const Vector centre = {radius * std::sin(angle), -radius * std::cos(angle),
                           kHeight_m + 0.02 * scatter(engine)};
    const Vector aim = {kTarget_m[0] + 0.03 * scatter(engine),
                        kTarget_m[1] + 0.03 * scatter(engine),
                        kTarget_m[2] + 0.03 * scatter(engine)};
    const double roll = 0.005 * scatter(engine);
    const double focal = kFocalPerWidth * size.width * (1 + 0.01 * scatter(engine));

    CameraModel camera;
    char name[16];
    std::snprintf(name, sizeof name, "cam%02u", i + 1);
    camera.name = name;
    camera.image_size = size;
    camera.focal_px = {focal, focal};
    camera.centre_px = {(size.width - 1) * 0.5 + 4 * scatter(engine),
                        (size.height - 1) * 0.5 + 4 * scatter(engine)};
    camera.distortion = {-0.08 + 0.01 * scatter(engine), 0.02 + 0.005 * scatter(engine),
                         2e-4 * scatter(engine), 2e-4 * scatter(engine), 0};
    camera.rotation = lookAt(centre, aim, roll);
    for (std::size_t row = 0; row < 3; ++row) {
      camera.translation_m[row] = -dot(camera.rotation[row], centre);
    }
    rig.cameras.push_back(camera);
  }
  return rig;
}

}  // namespace emulator

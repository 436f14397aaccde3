#include "hal/emulated/rig/hall.h"

#include <algorithm>
#include <random>

#include <opencv2/calib3d.hpp>

#include "hal/emulated/rig/mannequin.h"
#include "hal/emulated/rig/room.h"
#include "hal/emulated/rig/vec3.h"

namespace emulator {
namespace {

constexpr float kFullScale = 235;
constexpr int kRayGridPx = 16;

/// Undistorted viewing directions of a camera: exact on a grid of kRayGridPx, in between linear
/// (under 0.01 px off for lenses as mild as the rig's).
class Rays {
 public:
  explicit Rays(const CameraModel& camera) : columns_(camera.image_size.width / kRayGridPx + 2) {
    const int columns = static_cast<int>(columns_);
    const int rows = static_cast<int>(camera.image_size.height) / kRayGridPx + 2;
    std::vector<cv::Point2d> pixels;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        pixels.emplace_back(column * kRayGridPx, row * kRayGridPx);
      }
    }
    const cv::Matx33d intrinsics(camera.focal_px[0], 0, camera.centre_px[0], 0, camera.focal_px[1],
                                 camera.centre_px[1], 0, 0, 1);
    const cv::TermCriteria precise(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 1e-9);
    cv::undistortPoints(pixels, nodes_, intrinsics,
                        cv::Mat(1, 5, CV_64F, const_cast<double*>(camera.distortion.data())),
                        cv::noArray(), cv::noArray(), precise);
  }

  /// In camera axes, z = 1.
  [[nodiscard]] Vec3 at(int x, int y) const {
    const auto column = static_cast<std::size_t>(x / kRayGridPx);
    const auto row = static_cast<std::size_t>(y / kRayGridPx);
    const double u = static_cast<double>(x % kRayGridPx) / kRayGridPx;
    const double v = static_cast<double>(y % kRayGridPx) / kRayGridPx;
    const std::size_t first = row * columns_ + column;
    const std::size_t below = first + columns_;
    const cv::Point2d top = nodes_[first] * (1 - u) + nodes_[first + 1] * u;
    const cv::Point2d bottom = nodes_[below] * (1 - u) + nodes_[below + 1] * u;
    const cv::Point2d p = top * (1 - v) + bottom * v;
    return {static_cast<float>(p.x), static_cast<float>(p.y), 1};
  }

 private:
  std::size_t columns_;
  std::vector<cv::Point2d> nodes_;
};

/// Turns camera axes into the rig's, and knows where the camera stands.
struct Pose {
  std::array<Vec3, 3> rows;  // of the rotation rig to camera
  Vec3 centre;

  explicit Pose(const CameraModel& camera) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& r = camera.rotation[i];
      rows[i] = {static_cast<float>(r[0]), static_cast<float>(r[1]), static_cast<float>(r[2])};
    }
    const auto& t = camera.translation_m;
    centre =
        toRig({static_cast<float>(-t[0]), static_cast<float>(-t[1]), static_cast<float>(-t[2])});
  }
  [[nodiscard]] Vec3 toRig(Vec3 v) const { return rows[0] * v.x + rows[1] * v.y + rows[2] * v.z; }
};

Vec3 shadeMannequin(Vec3 point, Vec3 direction) {
  const Vec3 normal = mannequinNormal(point);
  const Vec3 albedo = mannequinSurface(point).albedo;
  const Vec3 start = point + normal * 0.01f;
  const float key = std::max(dot(normal, unit(kKeyLight - point)), 0.0f) *
                    mannequinShadow(start, kKeyLight, 0.08f);
  const float fill = std::max(dot(normal, unit(kFillLight - point)), 0.0f);
  const float sky = 0.5f + 0.5f * normal.z;
  const float edge = 1 - std::max(-dot(normal, direction), 0.0f);
  const float rim = 0.10f * edge * edge * edge;
  const float crease = clamp01(0.35f + mannequinDistance(point + normal * 0.06f) / 0.06f * 0.65f);
  const Vec3 light = Vec3{1.0f, 0.96f, 0.90f} * (0.85f * key) +
                     Vec3{0.92f, 0.97f, 1.0f} * (0.35f * fill) +
                     Vec3{0.95f, 0.98f, 1.0f} * ((0.14f + 0.24f * sky) * crease);
  return albedo * light + Vec3{1, 1, 1} * (rim * sky);
}

Vec3 shade(const Pose& pose, Vec3 direction, float footprint) {
  const MannequinHit hit = traceMannequin(pose.centre, direction, footprint);
  if (hit.coverage >= 1) return shadeMannequin(hit.point, direction);
  const Vec3 room = shadeRoom(pose.centre, direction, footprint);
  if (hit.coverage <= 0) return room;
  return mix(room, shadeMannequin(hit.point, direction), hit.coverage);
}

}  // namespace

std::vector<std::uint8_t> drawHall(const CameraModel& camera) {
  const int width = static_cast<int>(camera.image_size.width);
  const int height = static_cast<int>(camera.image_size.height);
  const Rays rays(camera);
  const Pose pose(camera);
  const float footprint = 1.0f / static_cast<float>(camera.focal_px[0]);
  std::minstd_rand noise(1);
  std::vector<std::uint8_t> out;
  out.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec3 light = shade(pose, unit(pose.toRig(rays.at(x, y))), footprint);
      const bool red = x % 2 == 0 && y % 2 == 0;
      const bool blue = x % 2 != 0 && y % 2 != 0;
      const float value = (red ? light.x : blue ? light.z : light.y) * kFullScale;
      // Sensor noise of about one step keeps dark gradients free of bands.
      const float dither = static_cast<float>(noise() % 2048) / 1024.0f - 0.5f;
      out.push_back(static_cast<std::uint8_t>(std::clamp(value + dither, 0.0f, 255.0f)));
    }
  }
  return out;
}

}  // namespace emulator

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <rapidcheck/gtest.h>

#include "appliance/geometry/coverage.h"
#include "tests/property/random_rig.h"

namespace {

using appliance::CoverZoom;
using appliance::coverZoom;
using appliance::Rig;
using appliance::RigCamera;
using appliance::sharedEdge;
using appliance::SharedEdge;
using appliance::Sight;
using appliance::TargetVolume;
using appliance::View;
using appliance::viewOf;
using appliance::ViewParameters;
using Eigen::Vector3d;
using geometry_test::anyIn;
using geometry_test::between;
using geometry_test::randomScene;
using geometry_test::Scene;
using hal::EdgeMask;
using property_test::anyBits;

/// Whether the display's pixel (x, y) has a source, by OpenCV's own lens.
bool hasPicture(const RigCamera& camera, const View& view, double x, double y) {
  const auto& h = view.H_camera_display;
  const double w = h[6] * x + h[7] * y + h[8];
  if (!(w > 0)) return false;
  const hal::Lens& lens = camera.lens;
  const cv::Point3d ray(((h[0] * x + h[1] * y + h[2]) / w - lens.cx_px) / lens.fx_px,
                        ((h[3] * x + h[4] * y + h[5]) / w - lens.cy_px) / lens.fy_px, 1);
  if (!(std::hypot(ray.x, ray.y) <= lens.max_radius)) return false;
  const cv::Matx33d A(lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1);
  std::vector<cv::Point2d> source;
  cv::projectPoints(std::vector<cv::Point3d>{ray}, cv::Vec3d(), cv::Vec3d(), A,
                    std::vector<double>(lens.distortion.begin(), lens.distortion.end()), source);
  return source[0].x > -1e-6 && source[0].y > -1e-6 && source[0].x < camera.width_px - 1 + 1e-6 &&
         source[0].y < camera.height_px - 1 + 1e-6;
}

/// The part of the display's pixels on its edge, and of some within, that have no picture.
int missingPixels(const RigCamera& camera, const View& view, const ViewParameters& parameters) {
  constexpr int kSteps = 100;
  const double last_x = parameters.width_px - 1.0;
  const double last_y = parameters.height_px - 1.0;
  int missing = 0;
  const auto look = [&](double x, double y) {
    if (!hasPicture(camera, view, x, y)) ++missing;
  };
  for (int i = 0; i <= kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    look(part * last_x, 0);
    look(part * last_x, last_y);
    look(0, part * last_y);
    look(last_x, part * last_y);
    look(between(0, last_x), between(0, last_y));
  }
  return missing;
}

TargetVolume randomVolume(const Vector3d& centre_m) {
  TargetVolume volume;
  const bool box = anyBits<bool>();
  volume.shape = box ? TargetVolume::Shape::kBox : TargetVolume::Shape::kCylinder;
  volume.centre_m = centre_m;
  const double across = between(0, 0.5);
  volume.half_size_m = {across, box ? between(0, 0.5) : across, between(0, 0.5)};
  return volume;
}

Vector3d randomTarget(const TargetVolume& volume) {
  Vector3d in{between(-1, 1), between(-1, 1), between(-1, 1)};
  if (volume.shape == TargetVolume::Shape::kCylinder) {
    const double out = std::hypot(in.x(), in.y());
    if (out > 1) in.head<2>() /= out;
  }
  return volume.centre_m.value() + in.cwiseProduct(volume.half_size_m);
}

Scene sceneWithVolume() {
  Scene scene = randomScene();
  scene.rig.target_volume = randomVolume(scene.target_m);
  return scene;
}

RC_GTEST_PROP(CoverZoom, LeavesNoBorderForAnyTargetOfTheVolume, ()) {
  Scene scene = sceneWithVolume();
  const CoverZoom cover =
      coverZoom(scene.rig, scene.parameters.width_px, scene.parameters.height_px);
  const double needed = cover.needed[cover.worst];
  RC_PRE(needed > 0 && needed < 100);
  scene.parameters.zoom = needed;
  const Vector3d target_m = randomTarget(scene.rig.target_volume);
  for (std::size_t i = 0; i < scene.rig.cameras.size(); ++i) {
    if (cover.needed[i] == 0) continue;
    const RigCamera& camera = scene.rig.cameras[i];
    const View view = viewOf(camera, scene.rig, target_m, scene.parameters);
    RC_ASSERT(missingPixels(camera, view, scene.parameters) == 0);
  }
}

RC_GTEST_PROP(CoverZoom, IsTheSmallestOne, ()) {
  Scene scene = sceneWithVolume();
  scene.rig.target_volume.half_size_m = Vector3d::Zero();
  const CoverZoom cover =
      coverZoom(scene.rig, scene.parameters.width_px, scene.parameters.height_px);
  const double needed = cover.needed[cover.worst];
  RC_PRE(needed > 0.1 && needed < 100);
  scene.parameters.zoom = needed * EdgeMask::kNone * 0.98;
  const RigCamera& worst = scene.rig.cameras[cover.worst];
  const View view = viewOf(worst, scene.rig, scene.target_m, scene.parameters);
  hal::EdgeMask mask;
  RC_ASSERT(tryNarrow(mask, worst, view, scene.parameters) == Sight::kGood);
  RC_ASSERT(std::ranges::max(mask.narrowing) > 1);
}

RC_GTEST_PROP(CoverZoom, IsCappedAndNamesTheCameraThatNeedsMost, ()) {
  const Scene scene = sceneWithVolume();
  const CoverZoom cover =
      coverZoom(scene.rig, scene.parameters.width_px, scene.parameters.height_px);
  RC_ASSERT(cover.zoom <= appliance::kMostCoverZoom);
  RC_ASSERT(cover.worst < scene.rig.cameras.size());
  for (const double needed : cover.needed) RC_ASSERT(needed <= cover.needed[cover.worst]);
}

RC_GTEST_PROP(SharedEdge, EndsWithinThePictureOfEveryViewOfGoodSight, ()) {
  const Scene scene = randomScene();
  std::vector<View> views(scene.rig.cameras.size());
  computeViews(scene.rig, scene.target_m, scene.parameters, views);
  const SharedEdge edge = sharedEdge(scene.rig, views, scene.parameters);
  const double place = between(0, EdgeMask::kPlaces);
  const auto before = EdgeMask::pointOf(static_cast<std::size_t>(place) % EdgeMask::kPlaces);
  const auto after = EdgeMask::pointOf((static_cast<std::size_t>(place) + 1) % EdgeMask::kPlaces);
  const double part = place - std::floor(place);
  const double u = (1 - part) * before[0] + part * after[0];
  const double v = (1 - part) * before[1] + part * after[1];
  // A lens bends the edge of its picture between two places: half a percent and a pixel.
  const double reach = std::min(1.0, 1 / edge.mask.at(u, v)) * 0.995;
  const double x =
      (reach * u * (scene.parameters.width_px - 2) + scene.parameters.width_px - 1) / 2;
  const double y =
      (reach * v * (scene.parameters.height_px - 2) + scene.parameters.height_px - 1) / 2;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (edge.sight[i] == Sight::kGood) RC_ASSERT(hasPicture(scene.rig.cameras[i], views[i], x, y));
  }
}

RC_GTEST_PROP(SharedEdge, HasNoSightOfWhatLiesOutsideThePicture, ()) {
  const Scene scene = randomScene();
  std::vector<View> views(scene.rig.cameras.size());
  computeViews(scene.rig, scene.target_m, scene.parameters, views);
  const SharedEdge edge = sharedEdge(scene.rig, views, scene.parameters);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const bool seen =
        hasPicture(scene.rig.cameras[i], views[i], (scene.parameters.width_px - 1.0) / 2,
                   (scene.parameters.height_px - 1.0) / 2);
    RC_ASSERT(seen == (edge.sight[i] != Sight::kNone));
  }
  RC_ASSERT(std::ranges::all_of(edge.mask.narrowing, [](float n) {
    return n >= EdgeMask::kNone && n <= appliance::kMostNarrowing * 1.01;
  }));
}

}  // namespace

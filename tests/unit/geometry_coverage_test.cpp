#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "appliance/geometry/coverage.h"
#include "appliance/geometry/lens.h"

namespace {

using appliance::coverZoom;
using appliance::Rig;
using appliance::RigCamera;
using appliance::sharedEdge;
using appliance::SharedEdge;
using appliance::Sight;
using appliance::View;
using appliance::ViewParameters;
using Eigen::Vector3d;
using hal::EdgeMask;

constexpr std::uint32_t kWidth = 1920;
constexpr std::uint32_t kHeight = 1080;

RigCamera cameraAt(const Vector3d& centre_m, const Vector3d& looks_at_m) {
  RigCamera camera;
  camera.width_px = 1280;
  camera.height_px = 1024;
  camera.lens = {.fx_px = 1180, .fy_px = 1180, .cx_px = 639.5, .cy_px = 511.5};
  camera.lens.max_radius = appliance::maxRadius(camera.lens, 1280, 1024);
  const Vector3d sight = (looks_at_m - centre_m).normalized();
  camera.R_cam_rig.row(0) = sight.cross(Vector3d::UnitZ()).normalized();
  camera.R_cam_rig.row(1) = sight.cross(camera.R_cam_rig.row(0).transpose());
  camera.R_cam_rig.row(2) = sight;
  camera.t_cam_rig_m = -(camera.R_cam_rig * centre_m);
  return camera;
}

/// 20 cameras on half a circle of 4 m around the working point, 1 m above the floor; each aimed
/// beside it by @p off_m, in another direction.
Rig arc(double off_m = 0) {
  Rig rig;
  rig.target_m = {0, 0, 1};
  rig.target_volume = {.half_size_m = {0.1, 0.1, 0.1}};
  for (int i = 0; i < 20; ++i) {
    const double angle = std::numbers::pi * i / 19;
    const Vector3d centre_m{4 * std::cos(angle), -4 * std::sin(angle), 1.2};
    const Vector3d off{off_m * std::sin(2.0 * i), off_m * std::cos(3.0 * i),
                       off_m * std::sin(5.0 * i)};
    rig.cameras.push_back(cameraAt(centre_m, rig.target_m + off));
  }
  fillReferences(rig);
  return rig;
}

SharedEdge edgeOf(const Rig& rig, const Vector3d& target_m, double zoom) {
  const ViewParameters parameters{.width_px = kWidth, .height_px = kHeight, .zoom = zoom};
  std::vector<View> views(rig.cameras.size());
  computeViews(rig, target_m, parameters, views);
  return sharedEdge(rig, views, parameters);
}

TEST(EdgeMask, HasItsPlacesClockwiseFromTheTopLeftCorner) {
  EXPECT_EQ(EdgeMask::pointOf(0), (std::array{-1.0, -1.0}));
  EXPECT_EQ(EdgeMask::pointOf(16), (std::array{1.0, -1.0}));
  EXPECT_EQ(EdgeMask::pointOf(24), (std::array{1.0, 0.0}));
  EXPECT_EQ(EdgeMask::pointOf(32), (std::array{1.0, 1.0}));
  EXPECT_EQ(EdgeMask::pointOf(48), (std::array{-1.0, 1.0}));
  EdgeMask mask;
  for (std::size_t place = 0; place < EdgeMask::kPlaces; ++place) {
    mask.narrowing[place] = static_cast<float>(1 + place);
    const auto [u, v] = EdgeMask::pointOf(place);
    EXPECT_NEAR(mask.at(u, v), 1.0 + static_cast<double>(place), 1e-6) << place;
    EXPECT_NEAR(mask.at(u / 2, v / 2), (1.0 + static_cast<double>(place)) / 2, 1e-6) << place;
  }
  EXPECT_EQ(mask.at(0, 0), 0);
}

TEST(EdgeMask, KeepsAStraightEdgeStraight) {
  // The picture ends at 0.9 u - 0.2 v = 0.5.
  EdgeMask mask{.narrowing = EdgeMask::everywhere(0)};
  for (std::size_t place = 0; place < EdgeMask::kPlaces; ++place) {
    const auto [u, v] = EdgeMask::pointOf(place);
    mask.narrowing[place] = static_cast<float>(std::max(0.0, (0.9 * u - 0.2 * v) / 0.5));
  }
  for (const double v : {-0.9, -0.31, 0.07, 0.66})
    EXPECT_NEAR(mask.at((0.5 + 0.2 * v) / 0.9, v), 1, 1e-6) << v;
}

TEST(CoverZoom, ShowsAWholeAthleteOnAUsualRig) {
  for (const double off_m : {0.0, 0.1, 0.2}) {
    const auto cover = coverZoom(arc(off_m), kWidth, kHeight);
    RecordProperty("zoom_off_" + std::to_string(off_m), std::to_string(cover.zoom));
    EXPECT_GT(cover.zoom, 1.4);
    EXPECT_LT(cover.zoom, 2) << off_m;
  }
}

TEST(CoverZoom, IsCappedAndTheWorstCameraIsKnown) {
  Rig rig = arc();
  rig.cameras[6] = cameraAt({3, -2, 1.2}, rig.target_m + Vector3d(-0.9, -1.2, 0));
  const auto cover = coverZoom(rig, kWidth, kHeight);
  EXPECT_EQ(cover.zoom, appliance::kMostCoverZoom);
  EXPECT_EQ(cover.worst, 6u);
  EXPECT_GT(cover.needed[6], appliance::kMostCoverZoom);
}

TEST(CoverZoom, DoesNotCountACameraThatLooksElsewhere) {
  Rig rig = arc();
  rig.cameras[6] = cameraAt({3, -2, 1.2}, {6, -4, 1});
  const auto cover = coverZoom(rig, kWidth, kHeight);
  EXPECT_EQ(cover.needed[6], 0);
  EXPECT_LT(cover.zoom, 2);
}

TEST(SharedEdge, IsNoneAtCoverZoom) {
  const Rig rig = arc(0.1);
  const auto cover = coverZoom(rig, kWidth, kHeight);
  EXPECT_FALSE(edgeOf(rig, rig.target_m, cover.zoom).mask.active());
  EXPECT_TRUE(edgeOf(rig, rig.target_m, 1).mask.active());
}

TEST(SharedEdge, IsNotNarrowedByAViewOfPoorSight) {
  Rig rig = arc();
  const EdgeMask before = edgeOf(rig, rig.target_m, 1).mask;
  // The target stands at the very edge of that camera's picture.
  rig.cameras[6] = cameraAt({3, -2, 1.2}, rig.target_m + Vector3d(-0.9, -1.2, 0));
  const SharedEdge edge = edgeOf(rig, rig.target_m, 1);
  EXPECT_EQ(edge.sight[6], Sight::kPoor);
  EXPECT_EQ(edge.sight[5], Sight::kGood);
  for (std::size_t place = 0; place < EdgeMask::kPlaces; ++place)
    EXPECT_LE(edge.mask.narrowing[place], before.narrowing[place] + 1e-6);
}

TEST(SharedEdge, KnowsTheViewsThatCannotSeeTheTarget) {
  Rig rig = arc();
  rig.cameras[2] = cameraAt({3, -2, 1.2}, {6, -4, 1});  // looks away
  const SharedEdge edge = edgeOf(rig, rig.target_m, 1);
  EXPECT_EQ(edge.sight[2], Sight::kNone);
  EXPECT_EQ(edge.sight[3], Sight::kGood);
}

TEST(FilledPart, SaysHowMuchOfTheScreenIsPicture) {
  const Rig rig = arc();
  const ViewParameters parameters{.width_px = kWidth, .height_px = kHeight, .zoom = 1};
  const View view = viewOf(rig.cameras[10], rig, rig.target_m, parameters);
  // 1280x1024 scaled to the height of 1080 is 1350 pixels wide.
  EXPECT_NEAR(filledPart(rig.cameras[10], view, parameters), 1350.0 / 1920, 0.03);
  EXPECT_NEAR(usedPart(rig.cameras[10], view, parameters), 1, 0.03);
  const ViewParameters zoomed{.width_px = kWidth, .height_px = kHeight, .zoom = 2};
  const View near = viewOf(rig.cameras[10], rig, rig.target_m, zoomed);
  EXPECT_EQ(filledPart(rig.cameras[10], near, zoomed), 1);
  EXPECT_NEAR(usedPart(rig.cameras[10], near, zoomed), 1920 * 1080 / (2 * 1350.0 * 2 * 1080), 0.02);
}

}  // namespace

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/director/arc_path.h"
#include "appliance/geometry/rig.h"

namespace {

using appliance::ArcPath;

const auto kEvery = [](std::uint32_t) { return true; };

TEST(ArcPath, CountsAnglesFromTheFirstCameraWhicheverWayTheRigIsNumbered) {
  for (const auto& azimuths_deg : {std::array{350.0, 5.0, 45.0}, std::array{45.0, 30.0, -10.0}}) {
    const ArcPath arc(azimuths_deg);
    EXPECT_NEAR(arc.angleOf(0), 0, 1e-9);
    EXPECT_NEAR(arc.angleOf(1), 15, 1e-9);
    EXPECT_NEAR(arc.angleOf(2), 55, 1e-9);
    EXPECT_NEAR(arc.length_deg(), 55, 1e-9);
    EXPECT_NEAR(arc.meanStep_deg(), 27.5, 1e-9);
  }
}

TEST(ArcPath, AnAngleLiesBetweenTwoCameras) {
  const ArcPath arc(std::array{0.0, 10.0, 30.0});
  const auto place = arc.at(15);
  EXPECT_EQ(place.left, 1u);
  EXPECT_EQ(place.right, 2u);
  EXPECT_NEAR(place.mix, 0.25, 1e-9);
  EXPECT_EQ(arc.at(-3).right, 0u);
  EXPECT_EQ(arc.at(99).left, 2u);
}

TEST(ArcPath, TheNearestCameraIsFoundAmongThoseThatAreUsable) {
  const ArcPath arc(std::array{0.0, 10.0, 30.0});
  EXPECT_EQ(arc.nearest(19, kEvery), 1u);
  EXPECT_EQ(arc.nearest(20, kEvery), 1u) << "of two equally near ones the first";
  EXPECT_EQ(arc.nearest(21, kEvery), 2u);
  EXPECT_EQ(arc.nearest(12, [](std::uint32_t camera) { return camera != 1; }), 0u);
  EXPECT_EQ(arc.nearest(12, [](std::uint32_t) { return false; }), std::nullopt);
}

TEST(ArcPath, ARingIsCutAtItsWidestGap) {
  const ArcPath arc(std::array{0.0, 80.0, 160.0, 260.0, 330.0});
  EXPECT_NEAR(arc.angleOf(3), 0, 1e-9);
  EXPECT_NEAR(arc.angleOf(4), 70, 1e-9);
  EXPECT_NEAR(arc.angleOf(0), 100, 1e-9);
  EXPECT_NEAR(arc.angleOf(2), 260, 1e-9);
}

TEST(ArcPath, TakesARigsCamerasAroundItsTarget) {
  appliance::Rig rig;
  rig.target_m = {1, 2, 1};
  for (const Eigen::Vector3d& centre_m :
       {Eigen::Vector3d{5, 2, 3}, Eigen::Vector3d{4, 5, 1}, Eigen::Vector3d{1, 7, 9}}) {
    appliance::RigCamera camera;
    camera.t_cam_rig_m = -centre_m;
    rig.cameras.push_back(camera);
  }
  const ArcPath arc = appliance::arcOf(rig);
  EXPECT_NEAR(arc.angleOf(0), 0, 1e-9);
  EXPECT_NEAR(arc.angleOf(1), 45, 1e-9);
  EXPECT_NEAR(arc.angleOf(2), 90, 1e-9);
}

TEST(ArcPath, WithoutCamerasHasNoViews) {
  const ArcPath arc;
  EXPECT_EQ(arc.nearest(5, kEvery), std::nullopt);
  EXPECT_EQ(arc.length_deg(), 0);
  EXPECT_EQ(ArcPath::even(1).meanStep_deg(), 0);
}

}  // namespace

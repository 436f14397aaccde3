#include <gtest/gtest.h>

#include "hal/emulated/studio/people_areas.h"

namespace {

using namespace emulator::studio;  // NOLINT(google-build-using-namespace)

constexpr float kNearest_m = 0.3f;

/// The camera in the middle of the arc, which looks at the rig's origin from 4 m away.
StudioCamera middleCamera() {
  return makeStudioRig(21, {1280, 1024}, 1).cameras[10];
}

/// Points of a board half a metre wide and two high that stands on the floor, across the view.
ShownBody boardAt(const StudioCamera& camera, double left_m, double ahead_m, float way_m = 0) {
  ShownBody board;
  const Eigen::Vector3d right = camera.rotation().row(0).transpose();
  Eigen::Vector3d forward = camera.rotation().row(2).transpose();
  forward.z() = 0;
  const Eigen::Vector3d foot = camera.centre() + ahead_m * forward.normalized() - left_m * right;
  for (int x = -5; x <= 5; ++x) {
    for (int z = 0; z <= 40; ++z) {
      Eigen::Vector3d p = foot + 0.05 * x * right;
      p.z() = 0.05 * z;
      const Eigen::Vector3f at = p.cast<float>();
      board.mesh.vertices.push_back({at, at, Eigen::Vector3f::UnitX()});
      board.mesh.bounds.extend(at);
    }
  }
  board.mesh.way_m = way_m;
  return board;
}

TEST(PeopleAreas, AreApartWherePeopleAreAndOneWhereTheyOverlap) {
  const StudioCamera camera = middleCamera();
  const std::vector<ShownBody> apart = {boardAt(camera, 1, 4), boardAt(camera, -1, 5)};
  EXPECT_EQ(peopleAreas(camera, apart, kNearest_m).size(), 2u);
  const std::vector<ShownBody> covered = {boardAt(camera, 0.1, 4), boardAt(camera, -0.1, 6)};
  const auto together = peopleAreas(camera, covered, kNearest_m);
  ASSERT_EQ(together.size(), 1u);
  EXPECT_EQ(together[0].people.size(), 2u);
}

TEST(PeopleAreas, HoldEveryPointThatThePictureShows) {
  const StudioCamera camera = middleCamera();
  const std::vector<ShownBody> people = {boardAt(camera, 0, 4)};
  const auto areas = peopleAreas(camera, people, kNearest_m);
  ASSERT_EQ(areas.size(), 1u);
  for (const auto& vertex : people[0].mesh.vertices) {
    const Eigen::Vector2d at = camera.project(vertex.opens.cast<double>());
    EXPECT_TRUE(areas[0].rect.contains({static_cast<int>(at.x()), static_cast<int>(at.y())}));
  }
  EXPECT_LT(areas[0].rect.width, 400) << "and little more";
}

TEST(PeopleAreas, AreCutAtThePicturesEdgeAndLeaveOutWhoIsOutsideOrBehind) {
  const StudioCamera camera = middleCamera();
  const std::vector<ShownBody> people = {boardAt(camera, 2.2, 4), boardAt(camera, 9, 4),
                                         boardAt(camera, 0, -2)};
  const auto areas = peopleAreas(camera, people, kNearest_m);
  ASSERT_EQ(areas.size(), 1u);
  EXPECT_EQ(areas[0].rect & cv::Rect(0, 0, 1280, 1024), areas[0].rect);
  EXPECT_EQ(areas[0].people.front(), &people[0]);
}

TEST(BlurSteps, AreAsManyAsTheWayInThePictureAsksFor) {
  const StudioCamera camera = middleCamera();
  const auto steps = [&](double ahead_m, float way_m) {
    const ShownBody board = boardAt(camera, 0, ahead_m, way_m);
    return blurSteps({.rect = {}, .people = {&board}}, camera);
  };
  EXPECT_EQ(steps(4, 0), 1);
  EXPECT_EQ(steps(4, 0.004f), 1) << "a pixel and a half";
  EXPECT_GT(steps(4, 0.03f), steps(8, 0.03f)) << "the same way farther off is shorter";
  EXPECT_LE(steps(1, 5), 8) << "a teleport is not drawn a hundred times";
}

}  // namespace

#include "hal/emulated/studio/studio_rig.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "hal/emulated/studio/random.h"

namespace {

using emulator::studio::makeStudioRig;
using emulator::studio::Random;
using emulator::studio::StudioCamera;

TEST(StudioRig, StandsOnAnArcOf110DegreesAtChestHeight) {
  const auto rig = makeStudioRig(20, {1280, 1024}, 1);
  ASSERT_EQ(rig.cameras.size(), 20u);
  double before = 0;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Eigen::Vector3d centre = rig.cameras[i].centre();
    EXPECT_NEAR(centre.z(), 1.2, 0.03);
    EXPECT_NEAR(centre.head<2>().norm(), 4.0, 0.07);
    const double angle = std::atan2(centre.x(), -centre.y()) * 180 / M_PI;
    if (i > 0) {
      EXPECT_NEAR(angle - before, 5.8, 1.0) << "between cameras " << i << " and " << i + 1;
    }
    before = angle;
  }
}

TEST(StudioRig, SeesTheAthleteInTheMiddleOfEveryView) {
  for (const StudioCamera& camera : makeStudioRig(20, {1280, 1024}, 3).cameras) {
    const Eigen::Vector2d middle = camera.project({0, 0, 1.05});
    EXPECT_NEAR(middle.x(), 640, 60);
    EXPECT_NEAR(middle.y(), 512, 60);
  }
}

TEST(StudioRig, ProjectsAsOpenCvDoes) {
  Random random(7);
  for (const StudioCamera& camera : makeStudioRig(20, {1280, 1024}, 2).cameras) {
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 40; ++i) {
      points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 2));
    }
    const auto& m = camera.model;
    cv::Mat turn;
    cv::Rodrigues(cv::Mat(3, 3, CV_64F, const_cast<double*>(m.rotation[0].data())), turn);
    const cv::Matx33d lens(m.focal_px[0], 0, m.centre_px[0], 0, m.focal_px[1], m.centre_px[1], 0, 0,
                           1);
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, turn,
                      cv::Mat(3, 1, CV_64F, const_cast<double*>(m.translation_m.data())), lens,
                      cv::Mat(1, 5, CV_64F, const_cast<double*>(m.distortion.data())), expected);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d ours = camera.project({points[i].x, points[i].y, points[i].z});
      EXPECT_NEAR(ours.x(), expected[i].x, 1e-6);
      EXPECT_NEAR(ours.y(), expected[i].y, 1e-6);
    }
  }
}

TEST(StudioRig, IsTheSameForTheSameSeedOnly) {
  const auto first = makeStudioRig(20, {1280, 1024}, 5);
  const auto again = makeStudioRig(20, {1280, 1024}, 5);
  const auto other = makeStudioRig(20, {1280, 1024}, 6);
  EXPECT_EQ(toToml(first.model()), toToml(again.model()));
  EXPECT_NE(toToml(first.model()), toToml(other.model()));
}

TEST(StudioRig, TellsTheGainsThatUndoEachCamerasColours) {
  for (const StudioCamera& camera : makeStudioRig(20, {1280, 1024}, 1).cameras) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(camera.response[c] * camera.model.gain_rgb[c], 1, 1e-12);
    }
    EXPECT_NEAR(camera.falloff(camera.model.centre_px[0], camera.model.centre_px[1]), 1, 1e-12);
    EXPECT_LT(camera.falloff(0, 0), 0.95);
  }
}

}  // namespace

/// The studio as other people's software sees it. Minutes: its label is studio.
#include "hal/emulated/studio/studio_scene.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include "hal/emulated/studio/depth_view.h"
#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/shown.h"
#include "hal/emulated/studio/world.h"

namespace {

namespace fs = std::filesystem;
using namespace emulator::studio;

void quiet(double /*share*/, const char* /*what*/) {}

/// Two small cameras and a fraction of a second.
StudioOptions small(std::uint64_t seed) {
  return {.cameras = 2,
          .size = {320, 256},
          .seed = seed,
          .play_s = 0.2,
          .first_play_s = 0.2,
          .patience_s = 1e6,
          .cache = {}};
}

std::vector<cv::Mat> picturesOf(const Play& play) {
  std::vector<cv::Mat> pictures;
  for (std::uint32_t camera = 0; camera < 2; ++camera) {
    for (std::uint32_t moment = 0; moment < play.momentCount(); ++moment)
      pictures.push_back(rawPicture(play, camera, moment));
  }
  return pictures;
}

bool same(const std::vector<cv::Mat>& a, const std::vector<cv::Mat>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (cv::countNonZero(a[i] != b[i]) != 0) return false;
  }
  return true;
}

std::vector<cv::Mat> draw(const StudioOptions& options) {
  const auto play = Play::begin(options, quiet);
  if (!play) throw std::runtime_error(play.error());
  (*play)->waitFor((*play)->momentCount());
  return picturesOf(**play);
}

TEST(Studio, GivesTheSamePixelsForTheSameSeed) {
  const auto first = draw(small(7));
  ASSERT_EQ(first.size(), 16u);
  EXPECT_TRUE(same(first, draw(small(7))));
  EXPECT_FALSE(same(first, draw(small(8))));
}

TEST(Studio, GivesTheSamePixelsFromItsCacheEvenAfterDamage) {
  StudioOptions options = small(7);
  options.cache = fs::temp_directory_path() / ("kagami-studio-test." + std::to_string(::getpid()));
  fs::remove_all(options.cache);
  const auto drawn = draw(options);
  EXPECT_TRUE(same(drawn, draw(options))) << "read from the cache";
  int damaged = 0;
  for (const auto& entry : fs::recursive_directory_iterator(options.cache)) {
    const auto name = entry.path().filename();
    if (name == "camera-1" || name == "moments-0") {
      fs::resize_file(entry.path(), fs::file_size(entry.path()) / 2);
      ++damaged;
    }
  }
  EXPECT_EQ(damaged, 2);
  testing::internal::CaptureStderr();
  EXPECT_TRUE(same(drawn, draw(options))) << "two files were damaged";
  EXPECT_NE(testing::internal::GetCapturedStderr().find("damaged"), std::string::npos);
  fs::remove_all(options.cache);
}

TEST(Studio, ShowsEachTriggerItsMomentWhicheverSlotItGoesTo) {
  auto scene = StudioScene::make(small(7), quiet);
  ASSERT_TRUE(scene) << scene.error();
  (*scene)->play().waitFor(8);
  const auto& play = (*scene)->play();
  // In turn, with missed triggers, and again from the beginning.
  std::uint32_t slot = 0;
  for (const std::uint64_t trigger : {1U, 2U, 3U, 4U, 7U, 8U, 9U, 10U, 18U, 23U, 24U}) {
    const auto picture = (*scene)->expose(1, trigger, slot++ % emulator::kFrameHistory);
    const cv::Mat shown(256, 320, CV_8U, const_cast<std::uint8_t*>(picture.pieces[0].data()));
    const auto moment = static_cast<std::uint32_t>((trigger - 1) % 8);
    EXPECT_EQ(cv::countNonZero(shown != rawPicture(play, 1, moment)), 0) << "trigger " << trigger;
  }
}

TEST(Studio, StartsColdWithinAMinute) {
  const auto start = std::chrono::steady_clock::now();
  StudioOptions options;
  options.grow = false;
  const auto play = Play::begin(options, quiet);
  ASSERT_TRUE(play) << play.error();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("cold start: %.1f s to %.2f s of play of %u cameras\n", seconds,
              (*play)->readyCount() / kMoments_hz, options.cameras);
  EXPECT_GE((*play)->readyCount(), 2 * kVariants);

  const cv::Ptr<cv::SIFT> sift = cv::SIFT::create();
  std::size_t fewest = SIZE_MAX;
  for (std::uint32_t camera = 0; camera < options.cameras; ++camera) {
    cv::Mat grey;
    cv::cvtColor(shownPicture(**play, camera, 0), grey, cv::COLOR_BGR2GRAY);
    std::vector<cv::KeyPoint> found;
    sift->detect(grey, found);
    std::printf("%s: %zu SIFT keypoints\n", (*play)->rig().cameras[camera].model.name.c_str(),
                found.size());
    fewest = std::min(fewest, found.size());
  }
  EXPECT_GE(fewest, 800u);
}

TEST(Studio, DrawsTheAthleteWhereItsJointsAre) {
  StudioOptions options;
  const auto rig = makeStudioRig(options.cameras, options.size, options.seed);
  const World world(options.seed, World::Clothes::kNone);
  int joints = 0;
  int inside = 0;
  for (const std::uint32_t camera : {0u, 9u, 19u}) {
    const StudioCamera& c = rig.cameras[camera];
    const double second = 1 + 0.5 * camera;
    const auto depth = renderDepth(options, camera, second);
    ASSERT_TRUE(depth) << depth.error();
    const PoseAt pose = world.athlete().at(second + c.exposure_s / 2);
    std::vector<cv::Point3d> points;
    for (const Eigen::Vector3d& joint : pose.joints)
      points.emplace_back(joint.x(), joint.y(), joint.z());
    cv::Mat turn;
    cv::Rodrigues(cv::Mat(3, 3, CV_64F, const_cast<double*>(c.model.rotation[0].data())), turn);
    const cv::Matx33d lens(c.model.focal_px[0], 0, c.model.centre_px[0], 0, c.model.focal_px[1],
                           c.model.centre_px[1], 0, 0, 1);
    std::vector<cv::Point2d> seen;
    cv::projectPoints(
        points, turn, cv::Mat(3, 1, CV_64F, const_cast<double*>(c.model.translation_m.data())),
        lens, cv::Mat(1, 5, CV_64F, const_cast<double*>(c.model.distortion.data())), seen);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Vector3d& joint = pose.joints[i];
      const double away = (c.rotation().row(2) * (joint - c.centre()))(0);
      ASSERT_TRUE(cv::Rect(0, 0, 1280, 1024).contains(cv::Point(seen[i])));
      const double surface = depth->at<float>(static_cast<int>(std::lround(seen[i].y)),
                                              static_cast<int>(std::lround(seen[i].x)));
      ++joints;
      // A joint lies inside a body: what is seen there is nearer, and not by much more than a
      // body's own width, unless an arm is in between. Ankles and eyes lie close below the skin.
      if (surface < away + 0.025 && surface > away - 0.75) ++inside;
    }
  }
  std::printf("%d of %d joints lie behind the surface that is drawn there\n", inside, joints);
  EXPECT_GE(inside, joints * 95 / 100);
}

}  // namespace

/// The studio as other people's software sees it. Minutes: its label is studio.
#include "hal/emulated/studio/studio_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include "hal/emulated/studio/depth_view.h"
#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/shown.h"
#include "hal/emulated/studio/truth.h"
#include "hal/emulated/studio/world.h"
#include "tests/studio/projected_joints.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

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

TEST(Studio, DrawsOnOnlyWhileNoCameraSends) {
  StudioOptions options = small(7);
  options.play_s = 2;
  const auto play = Play::begin(options, quiet);
  ASSERT_TRUE(play) << play.error();
  (*play)->rest(rt::now() + std::chrono::hours(1));
  std::this_thread::sleep_for(std::chrono::seconds(2));  // what was begun is finished
  const std::uint32_t drawn = (*play)->readyCount();
  EXPECT_LT(drawn, (*play)->momentCount());
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_EQ((*play)->readyCount(), drawn);
  (*play)->rest({});
  (*play)->waitFor((*play)->momentCount());
  EXPECT_EQ((*play)->readyCount(), (*play)->momentCount());
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
    cv::Mat shown(256, 320, CV_8U);
    picture.copyTo({shown.data, shown.total()}, 0);
    const auto moment = static_cast<std::uint32_t>((trigger - 1) % 8);
    EXPECT_EQ(cv::countNonZero(shown != rawPicture(play, 1, moment)), 0) << "trigger " << trigger;
  }
}

TEST(Studio, StartsColdWithinAMinute) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  StudioOptions options;
  options.grow = false;
  const auto play = Play::begin(options, quiet);
  ASSERT_TRUE(play) << play.error();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("cold start: %.1f s (%.1f s of processor) to %.2f s of play of %u cameras\n", seconds,
              static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC,
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

/// Joints of the truth's files, projected by OpenCV with the cameras of the truth's files, meet the
/// lens that the pictures are drawn with.
TEST(Studio, TellsEveryJointWhereOpenCvSeesIt) {
  const test::TemporaryFolder folder;
  const StudioOptions options;
  ASSERT_TRUE(writeTruth(folder.path(), options));
  std::ifstream truth_file(folder / "truth.json");
  const auto truth = nlohmann::json::parse(truth_file);
  std::vector<Eigen::Vector3d> joints;
  std::ifstream moments(folder / "moments.jsonl");
  for (std::string line; std::getline(moments, line);) {
    const auto moment = nlohmann::json::parse(line);
    for (const auto& person : moment["people"]) {
      for (const auto& joint : person) joints.emplace_back(joint[0], joint[1], joint[2]);
    }
  }
  EXPECT_EQ(joints.size(), std::lround(options.play_s * kMoments_hz) * 3 * 17);
  const auto rig = makeStudioRig(options.cameras, options.size, options.seed);
  ASSERT_EQ(truth["cameras"].size(), rig.cameras.size());
  double most_px = 0;
  std::size_t checked = 0;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const StudioCamera& drawn = rig.cameras[c];
    StudioCamera described;
    const auto& written = truth["cameras"][c];
    described.model.focal_px = written["focal_px"];
    described.model.centre_px = written["centre_px"];
    described.model.distortion = written["distortion"];
    described.model.rotation = written["rotation_cam_rig"];
    described.model.translation_m = written["translation_cam_rig_m"];
    std::vector<Eigen::Vector3d> in_front;
    std::ranges::copy_if(joints, std::back_inserter(in_front), [&](const Eigen::Vector3d& joint) {
      return drawn.rotation().row(2).dot(joint - drawn.centre()) > 0.5;
    });
    const auto seen = projectJoints(in_front, described);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Vector2d ours = drawn.project(in_front[i]);
      if (ours.x() < 0 || ours.y() < 0 || ours.x() >= 1280 || ours.y() >= 1024) continue;
      ++checked;
      most_px = std::max(most_px, std::hypot(seen[i].x - ours.x(), seen[i].y - ours.y()));
    }
  }
  std::printf("%zu joints in pictures, off by %.5f px at most\n", checked, most_px);
  EXPECT_GT(checked, 500'000u);
  EXPECT_LT(most_px, 0.01);
}

TEST(Studio, DrawsTheAthleteWhereItsJointsAre) {
  StudioOptions options;
  const auto rig = makeStudioRig(options.cameras, options.size, options.seed);
  const World world(options.seed, World::Clothes::kNone);
  int joints = 0;
  int covered = 0;
  int inside = 0;
  for (const std::uint32_t camera : {0u, 4u, 9u, 14u, 19u}) {
    const StudioCamera& c = rig.cameras[camera];
    const double second = 1 + 0.5 * camera;
    const auto depth = renderDepth(options, camera, second);
    ASSERT_TRUE(depth) << depth.error();
    const PoseAt pose = world.athlete().at(second + c.exposure_s / 2);
    const std::vector<cv::Point2d> seen = projectJoints(pose.joints, c);
    const auto behind_others = coveredJoints(world, second, c, pose.joints, seen);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Vector3d& joint = pose.joints[i];
      const double away = (c.rotation().row(2) * (joint - c.centre()))(0);
      ASSERT_TRUE(cv::Rect(0, 0, 1280, 1024).contains(cv::Point(seen[i])));
      const double surface = depth->at<float>(static_cast<int>(std::lround(seen[i].y)),
                                              static_cast<int>(std::lround(seen[i].x)));
      if (behind_others[i]) {
        ++covered;
        continue;
      }
      ++joints;
      // A joint lies inside a body: what is seen there is nearer, and not by much more than a
      // body's own width, unless an arm is in between. Ankles and eyes lie close below the skin.
      if (surface < away + 0.025 && surface > away - 0.75) ++inside;
    }
  }
  std::printf(
      "%d of %d joints lie behind the surface that is drawn there; other people cover %d more\n",
      inside, joints, covered);
  EXPECT_GE(inside, joints * 95 / 100);
  EXPECT_LE(covered, joints / 4);
}

}  // namespace

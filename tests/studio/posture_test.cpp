/// People as a posture network sees them: a network that never saw a picture of ours must find the
/// athlete's joints where the truth says they are.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/play.h"
#include "hal/emulated/studio/scene_cache.h"
#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/shown.h"
#include "hal/emulated/studio/world.h"
#include "tests/studio/movenet.h"
#include "tests/studio/projected_joints.h"

namespace {

namespace fs = std::filesystem;
using namespace emulator::studio;

constexpr float kSure = 0.3f;
constexpr double kNear = 0.05;  // of the body's height
constexpr int kEnoughJoints = 14;
constexpr double kEnoughViews = 0.9;
/// A body turned away by more than this shows its back.
constexpr double kSide_deg = 90;
/// Views that show a little of the back are reported, too.
constexpr double kLittleBack_deg = 110;
constexpr double kMargin = 1.35;  // of the square about the joints

fs::path modelFolder() {
  if (const char* set = std::getenv("KAGAMI_POSTURE_MODEL"); set != nullptr && *set != 0)
    return set;
  return usualCache().parent_path() / "posture";
}

/// All over the play, and the instants of its first real throw.
std::vector<std::uint32_t> chosenMoments(const World& world, double play_s) {
  std::vector<std::uint32_t> moments;
  const auto add = [&](double second) {
    moments.push_back(static_cast<std::uint32_t>(std::lround(second * kMoments_hz)));
  };
  for (double second = 0.8; second < play_s; second += 1.6) add(second);
  for (const ThrowTruth& t : world.athlete().throws()) {
    if (t.kind != Action::kThrow) continue;
    for (const double second :
         {t.foot_contact, t.max_external_rotation, t.release, t.max_internal_rotation})
      add(second);
    break;
  }
  std::ranges::sort(moments);
  return moments;
}

/// How far the trunk is turned away from the camera: 0 frontal, 90 sideways.
double turnedAway_deg(const std::array<Eigen::Vector3d, 17>& joints, const StudioCamera& camera) {
  const Eigen::Vector3d right = joints[6] - joints[5] + joints[12] - joints[11];
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ().cross(right);
  Eigen::Vector3d to_camera = camera.centre() - (joints[11] + joints[12]) / 2;
  to_camera.z() = 0;
  return std::acos(std::clamp(forward.normalized().dot(to_camera.normalized()), -1.0, 1.0)) * 180 /
         std::numbers::pi;
}

/// Truth as small rings, what was found as dots: green within the bar.
void drawJoints(cv::Mat& picture, const std::vector<cv::Point2d>& truth,
                const std::array<SeenJoint, 17>& seen, const std::array<bool, 17>& good) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    cv::line(picture, cv::Point(truth[i]), cv::Point(seen[i].at_px), {255, 255, 255}, 1,
             cv::LINE_AA);
    cv::circle(picture, cv::Point(seen[i].at_px), 4,
               good[i] ? cv::Scalar(60, 220, 60) : cv::Scalar(40, 40, 255), -1, cv::LINE_AA);
    cv::circle(picture, cv::Point(truth[i]), 3, {255, 220, 0}, 1, cv::LINE_AA);
  }
}

TEST(Posture, IsFoundByANetworkThatNeverSawTheStudio) {
  auto network = MoveNet::load(modelFolder());
  if (!network)
    GTEST_SKIP() << network.error() << ": tests/studio/fetch_posture_model.sh gets them";

  StudioOptions options;
  const World world(options.seed, World::Clothes::kNone);
  options.only = chosenMoments(world, options.play_s);
  options.cache = usualCache();
  const auto play = Play::begin(options, [](double, const char*) {});
  ASSERT_TRUE(play) << play.error();
  (*play)->waitFor(static_cast<std::uint32_t>(options.only.size()));
  const char* pictures = std::getenv("KAGAMI_POSTURE_PICTURES");

  std::vector<int> found_joints;
  std::array<int, 17> misses{};
  int passed = 0;
  int left_out = 0;
  int back_views = 0;
  int back_passed = 0;
  int worst = 18;
  std::string worst_view;
  for (const std::uint32_t moment : options.only) {
    const double second = moment / kMoments_hz;
    int views = 0;
    int good_views = 0;
    std::vector<int> of_moment;
    for (std::uint32_t c = 0; c < options.cameras; ++c) {
      const StudioCamera& camera = (*play)->rig().cameras[c];
      const PoseAt pose = world.athlete().at(second + camera.exposure_s / 2);
      const double turned_deg = turnedAway_deg(pose.joints, camera);
      if (turned_deg > kLittleBack_deg) continue;
      const std::vector<cv::Point2d> truth = projectJoints(pose.joints, camera);
      // Such a view shows another person.
      if (std::ranges::count(coveredJoints(world, second, camera, pose.joints, truth), true) >
          17 - kEnoughJoints) {
        ++left_out;
        continue;
      }
      std::vector<cv::Point2f> corners(truth.begin(), truth.end());
      const cv::Rect box = cv::boundingRect(corners);
      const auto side = static_cast<float>(kMargin * std::max(box.width, box.height));
      const cv::Rect2f square(
          static_cast<float>(box.x) + static_cast<float>(box.width) / 2 - side / 2,
          static_cast<float>(box.y) + static_cast<float>(box.height) / 2 - side / 2, side, side);
      cv::Mat shown = shownPicture(**play, c, moment);
      const auto seen = network->find(shown, square);
      const Eigen::Vector3d pelvis = (pose.joints[11] + pose.joints[12]) / 2;
      const double tall_px = world.athleteShape().height_m * camera.model.focal_px[0] /
                             camera.rotation().row(2).dot(pelvis - camera.centre());
      std::array<bool, 17> good{};
      for (std::size_t i = 0; i < seen.size(); ++i) {
        good[i] = seen[i].confidence >= kSure &&
                  std::hypot(static_cast<double>(seen[i].at_px.x) - truth[i].x,
                             static_cast<double>(seen[i].at_px.y) - truth[i].y) <= kNear * tall_px;
      }
      const int count = static_cast<int>(std::ranges::count(good, true));
      if (turned_deg > kSide_deg) {
        ++back_views;
        back_passed += count >= kEnoughJoints ? 1 : 0;
        continue;
      }
      for (std::size_t i = 0; i < good.size(); ++i) misses[i] += good[i] ? 0 : 1;
      found_joints.push_back(count);
      of_moment.push_back(count);
      ++views;
      good_views += count >= kEnoughJoints ? 1 : 0;
      if (count < worst) {
        worst = count;
        char text[64];
        std::snprintf(text, sizeof text, "%s at %.3f s", camera.model.name.c_str(), second);
        worst_view = text;
      }
      if (pictures != nullptr) {
        drawJoints(shown, truth, seen, good);
        char name[64];
        std::snprintf(name, sizeof name, "%02d-%s-%06.3f.jpg", count, camera.model.name.c_str(),
                      second);
        cv::imwrite((fs::path(pictures) / name).string(),
                    shown(cv::Rect(square) & cv::Rect(0, 0, shown.cols, shown.rows)));
      }
    }
    passed += good_views;
    std::ranges::sort(of_moment);
    if (views > 0) {
      std::printf("%6.3f s %-17s: %2d of %2d views, joints median %d, fewest %d\n", second,
                  std::string(name(world.athlete().at(second).phase)).c_str(), good_views, views,
                  of_moment[of_moment.size() / 2], of_moment.front());
    }
  }
  ASSERT_FALSE(found_joints.empty());
  std::ranges::sort(found_joints);
  const double share = passed / static_cast<double>(found_joints.size());
  std::printf(
      "%d of %zu views of front or side (%.1f %%) have %d joints and more; joints found: "
      "median %d of 17, fewest %d (%s)\n",
      passed, found_joints.size(), 100 * share, kEnoughJoints,
      found_joints[found_joints.size() / 2], worst, worst_view.c_str());
  std::printf("turned away by %.0f to %.0f degrees, beside the bar: %d of %d\n", kSide_deg,
              kLittleBack_deg, back_passed, back_views);
  std::printf("left out: %d views in which another person stands before more than %d joints\n",
              left_out, 17 - kEnoughJoints);
  constexpr std::array<const char*, 17> kNames = {
      "nose",           "left eye",   "right eye",   "left ear",   "right ear",   "left shoulder",
      "right shoulder", "left elbow", "right elbow", "left wrist", "right wrist", "left hip",
      "right hip",      "left knee",  "right knee",  "left ankle", "right ankle"};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    std::printf("%s missed in %.1f %%\n", kNames[i],
                100.0 * misses[i] / static_cast<double>(found_joints.size()));
  EXPECT_GE(share, kEnoughViews);
  EXPECT_LE(left_out, static_cast<int>(found_joints.size()) / 10);
}

}  // namespace

// The whole way of the studio's depth: drawn by the emulator, handed to the OpenNI2 driver, read
// through OpenNI2 as the daemon does, and compared with the truth. Minutes: its label is studio.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/emulated/openni/sensor_model.h"
#include "hal/emulated/studio/depth_sensor.h"
#include "hal/emulated/studio/posed_mesh.h"
#include "hal/emulated/studio/world.h"
#include "hal/openni/openni_sensor.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace std::chrono_literals;
using namespace emulator::studio;
using hal::openni::OpenniSensor;

constexpr std::uint64_t kSeed = 1;
constexpr int kReach_px = 6;  // around the middle of the pelvis

struct Pair {
  std::uint64_t number = 0;
  rt::Timestamp exposure;
  std::vector<std::uint16_t> depth_mm;
  std::vector<std::uint8_t> rgb;
};

struct Shown {
  rt::Timestamp exposure;
  double second = 0;
};

/// Pictures of the running studio through OpenNI2, and what the studio says it showed.
class StudioDepth : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<test::TemporaryFolder>();
    shared_memory_ = std::make_unique<test::TemporaryFolder>("/dev/shm");
    ::setenv("KAGAMI_DEPTH_RING", (*shared_memory_ / "ring").c_str(), 1);
    test::ChildProcess emulator({KAGAMI_EMULATOR,
                                 "--scene",
                                 "studio",
                                 "--depth-sensor",
                                 "--cameras",
                                 "1",
                                 "--size",
                                 "448x320",
                                 "--first-address",
                                 "127.0.9.11",
                                 "--wire-port",
                                 "3987",
                                 "--fault-port",
                                 "0",
                                 "--internal-trigger-hz",
                                 "40",
                                 "--studio-seed",
                                 std::to_string(kSeed),
                                 "--studio-seconds",
                                 "4",
                                 "--studio-grow",
                                 "false",
                                 "--studio-cache",
                                 (*scratch_ / "cache").string(),
                                 "--studio-truth",
                                 (*scratch_ / "truth").string()},
                                (*scratch_ / "emulator.log").string());
    ASSERT_TRUE(emulator.waitForOutput("ready", 300s)) << emulator.output();
    auto sensor = OpenniSensor::open({.drivers = KAGAMI_DEPTH_DRIVERS, .latency = 40ms});
    ASSERT_TRUE(sensor) << sensor.error();
    lens_ = {};
    for (int i = 0; i < 90; ++i) {
      const auto frame = (*sensor)->waitFrame(20s);
      ASSERT_TRUE(frame) << (*sensor)->status().message;
      if (i == 0) lens_ = frame->lens;
      if (i < 30) continue;  // the clock's fit settles
      pairs_.push_back({frame->number,
                        frame->exposure,
                        {frame->depth_mm.begin(), frame->depth_mm.end()},
                        {frame->colour_rgb.begin(), frame->colour_rgb.end()}});
    }
    lost_ = (*sensor)->status().lost;
    emulator.terminate();
    ASSERT_EQ(emulator.wait(30s), 0) << emulator.output();
    std::ifstream truth((*scratch_ / "truth/depth.csv").string());
    std::string line;
    std::getline(truth, line);
    while (std::getline(truth, line)) {
      unsigned long long number = 0;
      long long exposure_ns = 0;
      double second = 0;
      if (std::sscanf(line.c_str(), "%llu,%lld,%lf", &number, &exposure_ns, &second) == 3)
        shown_[number] = {rt::fromNs(exposure_ns), second};
    }
  }
  static void TearDownTestSuite() {
    pairs_.clear();
    shown_.clear();
    scratch_.reset();
    shared_memory_.reset();
  }

  static inline std::unique_ptr<test::TemporaryFolder> scratch_;
  static inline std::unique_ptr<test::TemporaryFolder> shared_memory_;  // of a killed emulator, too
  static inline std::vector<Pair> pairs_;
  static inline std::map<std::uint64_t, Shown> shown_;
  static inline hal::DepthLens lens_;
  static inline std::uint64_t lost_ = 0;
};

/// How far away the nearest surface of the bodies lies along one pixel's ray: metres along the
/// optical axis, by the triangles themselves (Moeller and Trumbore 1997). 0: none.
double surfaceAt(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles, double x, double y) {
  double nearest = 1e9;
  const Eigen::Vector3d ray(x, y, 1);
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3d u = b - a;
    const Eigen::Vector3d v = c - a;
    const Eigen::Vector3d p = ray.cross(v);
    const double det = u.dot(p);
    if (std::abs(det) < 1e-12) continue;
    const double s = -a.dot(p) / det;
    const Eigen::Vector3d q = (-a).cross(u);
    const double t = ray.dot(q) / det;
    const double z = v.dot(q) / det;
    if (s >= 0 && t >= 0 && s + t <= 1 && z > 0.1) nearest = std::min(nearest, z);
  }
  return nearest < 1e8 ? nearest : 0;
}

TEST_F(StudioDepth, MeasuresTheAthletesPelvisAsWellAsItsSensorCan) {
  ASSERT_EQ(pairs_.size(), 60u);
  const StudioCamera sensor = makeDepthSensor(kSeed);
  const emulator::RgbdFormat format = depthSensorFormat();
  EXPECT_NEAR(lens_.focal_x_px, format.focal_px, 0.01);
  EXPECT_NEAR(lens_.centre_y_px, format.centre_y_px, 0.01);
  const World world(kSeed);
  const emulator::SensorTraits traits;
  double sum = 0;
  double sum_expected = 0;
  double bias = 0;
  std::vector<double> behind;
  std::size_t count = 0;
  std::size_t holes = 0;
  for (std::size_t i = 0; i < pairs_.size(); i += 6) {
    const Pair& pair = pairs_[i];
    ASSERT_TRUE(shown_.contains(pair.number)) << pair.number;
    const double second = shown_[pair.number].second;
    const PoseAt pose = world.athlete().at(second);
    const Eigen::Vector3d pelvis = 0.5 * (pose.joints[11] + pose.joints[12]);
    const Eigen::Vector3d at = sensor.rotation() * (pelvis - sensor.centre());
    const Eigen::Vector2d pixel = sensor.project(pelvis);
    // Everybody's triangles near the ray.
    std::vector<std::array<Eigen::Vector3d, 3>> triangles;
    for (const PosedBody& body : world.at(second, 0).bodies) {
      PosedMesh mesh;
      const Body& surface = world.cast()[body.body].surface;
      poseMesh(surface, body.opens, body.closes, mesh);
      for (std::size_t t = 0; t + 2 < surface.triangles.size(); t += 3) {
        std::array<Eigen::Vector3d, 3> triangle;
        bool near = false;
        for (std::size_t k = 0; k < 3; ++k) {
          const Eigen::Vector3d point =
              mesh.vertices[surface.triangles[t + k]].opens.cast<double>();
          triangle[k] = sensor.rotation() * (point - sensor.centre());
          near |= triangle[k].z() > 0.3 &&
                  (sensor.project(point) - pixel).cwiseAbs().maxCoeff() < kReach_px + 12;
        }
        if (near) triangles.push_back(triangle);
      }
    }
    double middle = 0;
    for (int y = -kReach_px; y <= kReach_px; ++y) {
      for (int x = -kReach_px; x <= kReach_px; ++x) {
        const int column = static_cast<int>(std::lround(pixel.x())) + x;
        const int row = static_cast<int>(std::lround(pixel.y())) + y;
        ASSERT_TRUE(column >= 0 && column < 640 && row >= 0 && row < 480);
        const double truth = surfaceAt(triangles, (column - format.centre_x_px) / format.focal_px,
                                       (row - format.centre_y_px) / format.focal_px);
        if (truth <= 0 || truth > at.z() + 0.3) continue;  // beside the body
        if (x == 0 && y == 0) middle = truth;
        const double measured =
            pair.depth_mm[static_cast<std::size_t>(row) * 640 + static_cast<std::size_t>(column)] *
            1e-3;
        if (measured <= 0) {
          ++holes;
          continue;
        }
        const double error = measured - truth;
        const double one_px = truth * truth / (format.focal_px * traits.baseline_m);
        bias += error;
        sum += error * error;
        sum_expected += one_px * one_px *
                        (traits.disparity_noise_px * traits.disparity_noise_px +
                         traits.disparity_step_px * traits.disparity_step_px / 12);
        ++count;
      }
    }
    if (middle > 0) behind.push_back(at.z() - middle);
  }
  ASSERT_GT(count, 500u);
  ASSERT_GE(behind.size(), 8u);
  std::ranges::sort(behind);
  const double rms_mm = 1e3 * std::sqrt(sum / static_cast<double>(count));
  const double expected_mm = 1e3 * std::sqrt(sum_expected / static_cast<double>(count));
  const double bias_mm = 1e3 * bias / static_cast<double>(count);
  std::printf(
      "pelvis: %zu values of %zu pictures, off by %.1f mm rms (the sensor's own: %.1f mm), %+.1f "
      "mm "
      "in the mean, %zu holes; its middle lies %.0f mm behind the skin\n",
      count, behind.size(), rms_mm, expected_mm, bias_mm, holes, 1e3 * behind[behind.size() / 2]);
  EXPECT_LT(std::abs(bias_mm), 12);
  EXPECT_LT(rms_mm, 1.3 * expected_mm);
  EXPECT_GT(rms_mm, 0.5 * expected_mm) << "a sensor without noise is none";
  EXPECT_GT(behind[behind.size() / 2], 0.03) << "a joint lies inside its body";
  EXPECT_LT(behind[behind.size() / 2], 0.30);
}

TEST_F(StudioDepth, SeesColourWhereItSeesDepth) {
  ASSERT_EQ(pairs_.size(), 60u);
  constexpr int kFarthest_px = 8;
  std::array<double, 2 * kFarthest_px + 1> contrast{};
  std::size_t edges = 0;
  for (const Pair& pair : pairs_) {
    ASSERT_EQ(pair.rgb.size(), 3 * pair.depth_mm.size());
    for (std::size_t y = 40; y < 440; ++y) {
      for (std::size_t x = 20; x + 20 < 640; ++x) {
        const std::size_t i = 640 * y + x;
        const int left = pair.depth_mm[i];
        const int right = pair.depth_mm[i + 1];
        if (left == 0 || right == 0 || left > 5000 || right - left < 1000) continue;
        ++edges;
        for (std::size_t shift = 0; shift < contrast.size(); ++shift) {
          const std::size_t k = 3 * (i + shift - std::size_t{kFarthest_px});
          for (std::size_t c = 0; c < 3; ++c)
            contrast[shift] += std::abs(int{pair.rgb[k + 3 + c]} - int{pair.rgb[k + c]});
        }
      }
    }
  }
  ASSERT_GT(edges, 1000u);
  const auto best = static_cast<int>(std::ranges::max_element(contrast) - contrast.begin());
  std::printf("%zu edges of depth; colour changes most %+d px beside them\n", edges,
              best - kFarthest_px);
  EXPECT_LE(std::abs(best - kFarthest_px), 1);
}

TEST_F(StudioDepth, IsTakenInTheInstantsThatTheCamerasShow) {
  ASSERT_EQ(pairs_.size(), 60u);
  std::vector<rt::Nanoseconds> errors;
  for (const Pair& pair : pairs_)
    errors.push_back(std::chrono::abs(pair.exposure - shown_[pair.number].exposure));
  std::ranges::sort(errors);
  std::printf("exposure off by %.2f ms at the median, %.2f ms at most\n",
              static_cast<double>(errors[errors.size() / 2].count()) * 1e-6,
              static_cast<double>(errors.back().count()) * 1e-6);
  // Seconds of the play and of our clock run alike, except where the play begins again (58 of 59
  // steps here), and where a busy machine held the triggers up.
  int in_step = 0;
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    const Shown& a = shown_[pairs_[i - 1].number];
    const Shown& b = shown_[pairs_[i].number];
    const double apart = std::chrono::duration<double>(b.exposure - a.exposure).count();
    if (std::abs(b.second - a.second - apart) < 2e-3) ++in_step;
    const double picture = b.second * kDepth_hz;
    EXPECT_NEAR(picture, std::round(picture), 1e-3);
  }
  std::printf("%d of %zu steps of the play and of the clock are equal; %llu pictures lost\n",
              in_step, pairs_.size() - 1, static_cast<unsigned long long>(lost_));
  EXPECT_GE(in_step, 50);
}

}  // namespace

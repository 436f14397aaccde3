#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "hal/emulated/studio/athlete/performance.h"
#include "hal/emulated/studio/athlete/skeleton.h"
#include "hal/emulated/studio/athlete/tailor.h"

namespace emulator::studio {
namespace {

using Eigen::Vector3d;

Performance anyPerformance() {
  PerformanceOptions options;
  options.shape.height_m = 1.6 + 0.001 * *rc::gen::inRange(0, 400);
  options.shape.left_handed = *rc::gen::arbitrary<bool>();
  options.heading = 0.01 * *rc::gen::inRange(-314, 314);
  options.least_duration_s = 25;
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  return {seed, options};
}

double anyTime(const Performance& performance) {
  return performance.duration() * 0.0001 * *rc::gen::inRange(20, 9980);
}

/// Points under the ball of the foot and under the heel, rig frame.
std::array<Vector3d, 4> soles(const PoseAt& pose) {
  std::array<Vector3d, 4> points;
  std::size_t next = 0;
  for (const Side side : kSides) {
    const float x = side == Side::kRight ? 0.112F : -0.112F;
    const auto& foot = pose.bones[static_cast<std::size_t>(boneIndex(SideBone::kFoot, side))];
    for (const float y : {0.110F, -0.077F}) {
      points[next++] = (foot * Eigen::Vector3f{x, y, -kSoleDepth_m}).cast<double>();
    }
  }
  return points;
}

double angleAt(const Vector3d& a, const Vector3d& middle, const Vector3d& b) {
  const double c = (a - middle).normalized().dot((b - middle).normalized());
  return std::acos(std::clamp(c, -1.0, 1.0));
}

RC_GTEST_PROP(AthletePerformance, FeetThatStandDoNotSlide, ()) {
  const auto performance = anyPerformance();
  const double t0 = anyTime(performance);
  for (double t = t0; t < t0 + 0.5; t += 0.01) {
    const auto now = soles(performance.at(t));
    const auto next = soles(performance.at(t + 0.005));
    for (std::size_t i = 0; i < now.size(); ++i) {
      RC_ASSERT(now[i].z() > -0.006);
      if (now[i].z() > 0.0005 || next[i].z() > 0.0005) continue;
      RC_ASSERT((next[i] - now[i]).norm() < 0.001);
    }
  }
}

RC_GTEST_PROP(AthletePerformance, OneFootStandsUnlessItRuns, ()) {
  const auto performance = anyPerformance();
  const double t0 = anyTime(performance);
  for (double t = t0; t < t0 + 0.5; t += 0.02) {
    const auto pose = performance.at(t);
    if (pose.phase == Phase::kRun) continue;
    const auto points = soles(pose);
    const double lowest =
        std::ranges::min_element(points, {}, [](const auto& p) { return p.z(); })->z();
    RC_ASSERT(lowest < 0.012);
  }
}

RC_GTEST_PROP(AthletePerformance, LimbsKeepTheirLengthAndJointsTheirLimits, ()) {
  const auto performance = anyPerformance();
  const auto rest = performance.at(0);
  const double t = anyTime(performance);
  const auto pose = performance.at(t);
  const auto length = [](const PoseAt& p, std::size_t a, std::size_t b) {
    return (p.joints[a] - p.joints[b]).norm();
  };
  constexpr std::array<std::array<std::size_t, 3>, 4> kLimbs{
      {{5, 7, 9}, {6, 8, 10}, {11, 13, 15}, {12, 14, 16}}};
  for (const auto& limb : kLimbs) {
    RC_ASSERT(std::abs(length(pose, limb[0], limb[1]) - length(rest, limb[0], limb[1])) < 1e-6);
    RC_ASSERT(std::abs(length(pose, limb[1], limb[2]) - length(rest, limb[1], limb[2])) < 2e-3);
    const double inner = angleAt(pose.joints[limb[0]], pose.joints[limb[1]], pose.joints[limb[2]]);
    RC_ASSERT(inner > 0.45);  // no elbow or knee folds farther
  }
  RC_ASSERT(length(pose, 1, 2) > 0.9 * length(rest, 1, 2));
}

RC_GTEST_PROP(AthletePerformance, StaysBalancedOverItsFeet, ()) {
  const auto performance = anyPerformance();
  const auto pose = performance.at(anyTime(performance));
  const Vector3d hips = (pose.joints[11] + pose.joints[12]) / 2;
  const auto points = soles(pose);
  double nearest = 9;
  for (const auto& p : points) nearest = std::min(nearest, (p - hips).head<2>().norm());
  RC_ASSERT(nearest < 0.55);
  RC_ASSERT(hips.z() > 0.35 * 1.6);
}

RC_GTEST_PROP(AthletePerformance, MovesWithoutJerks, ()) {
  const auto performance = anyPerformance();
  const double t0 = anyTime(performance);
  constexpr double kStep = 0.002;
  // A jump of the velocity would double the second difference over h^2 whenever h is halved. The
  // coarse look begins and ends a step farther out: a foot leaves the floor within milliseconds,
  // and the fine one may see the beginning of that just before it ends.
  const auto hardest = [&](double h, double farther) {
    std::array<double, 17> most{};
    for (double t = t0 - farther; t < t0 + 0.15 + farther; t += h) {
      const auto a = performance.at(t - h);
      const auto b = performance.at(t);
      const auto c = performance.at(t + h);
      for (std::size_t j = 0; j < most.size(); ++j) {
        most[j] = std::max(most[j], (a.joints[j] - 2 * b.joints[j] + c.joints[j]).norm() / (h * h));
      }
    }
    return most;
  };
  const auto coarse = hardest(kStep, kStep);
  const auto fine = hardest(kStep / 4, 0);
  for (std::size_t j = 0; j < coarse.size(); ++j) {
    RC_ASSERT(fine[j] < 1.6 * coarse[j] + 10);
    RC_ASSERT(coarse[j] < 2500);  // m/s2; the wrist of a thrower reaches about 1500
  }
}

RC_GTEST_PROP(AthletePerformance, IsTheSameForTheSameSeed, (std::uint64_t seed)) {
  PerformanceOptions options;
  options.least_duration_s = 10;
  const Performance one(seed, options);
  const Performance two(seed, options);
  RC_ASSERT(one.duration() == two.duration());
  for (const double t : {1.0, 5.0, 9.0}) {
    const auto a = one.at(t);
    const auto b = two.at(t);
    for (std::size_t j = 0; j < 17; ++j) RC_ASSERT(a.joints[j] == b.joints[j]);
    RC_ASSERT(a.ball == b.ball);
  }
}

}  // namespace
}  // namespace emulator::studio

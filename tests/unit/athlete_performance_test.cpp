#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/emulated/studio/athlete/draw_shape.h"
#include "hal/emulated/studio/athlete/performance.h"
#include "hal/emulated/studio/athlete/skeleton.h"

namespace emulator::studio {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// COCO order.
constexpr std::size_t kNose = 0;
constexpr std::size_t kLeftWrist = 9, kRightWrist = 10;
constexpr std::size_t kLeftHip = 11, kRightHip = 12, kRightAnkle = 16;

PerformanceOptions doing(std::vector<Action> actions, double seconds = 12) {
  PerformanceOptions options;
  options.actions = std::move(actions);
  options.least_duration_s = seconds;
  return options;
}

Vector3d hips(const PoseAt& pose) {
  return (pose.joints[kLeftHip] + pose.joints[kRightHip]) / 2;
}

double speedOf(const Performance& p, std::size_t joint, double t) {
  return (p.at(t + 0.002).joints[joint] - p.at(t - 0.002).joints[joint]).norm() / 0.004;
}

TEST(Performance, StandsUprightOnTheFloorAtItsHome) {
  auto options = doing({Action::kStand}, 3);
  options.home = {1.5, -2};
  options.shape.height_m = 1.90;
  const Performance performance(4, options);
  const auto pose = performance.at(1.0);
  EXPECT_LT((hips(pose).head<2>() - options.home).norm(), 0.08);
  EXPECT_NEAR(pose.joints[kNose].z(), 1.90 * 1.65 / 1.80, 0.05);
  EXPECT_NEAR(pose.joints[kRightAnkle].z(), 1.90 * 0.1 / 1.80, 0.01);
  EXPECT_EQ(pose.bones.size(), static_cast<std::size_t>(kBones));
  EXPECT_EQ(pose.phase, Phase::kStand);
}

TEST(Performance, ThrowsWithInstantsInOrderAndTheHandFastestAtRelease) {
  const Performance performance(7, doing({Action::kThrow}, 30));
  ASSERT_GE(performance.throws().size(), 4U);
  for (const auto& truth : performance.throws()) {
    EXPECT_LT(truth.wind_up, truth.stride);
    EXPECT_LT(truth.stride, truth.foot_contact);
    EXPECT_LT(truth.foot_contact, truth.max_external_rotation);
    EXPECT_LT(truth.max_external_rotation, truth.release);
    EXPECT_LT(truth.release, truth.max_internal_rotation);
    EXPECT_LT(truth.max_internal_rotation, truth.end);
    EXPECT_GE(truth.speed, 0.85);
    EXPECT_LE(truth.speed, 1.15);
    double fastest = 0;
    double when = 0;
    for (double t = truth.wind_up; t < truth.end; t += 0.005) {
      const double speed = speedOf(performance, kRightWrist, t);
      if (speed > fastest) {
        fastest = speed;
        when = t;
      }
    }
    EXPECT_NEAR(when, truth.release, 0.02);
    EXPECT_GT(fastest, 6.0) << "m/s of the wrist";
    EXPECT_LT(fastest, 25.0);
  }
}

TEST(Performance, TellsThePhaseOfEveryInstantOfAThrow) {
  const Performance performance(7, doing({Action::kThrow}));
  const auto& truth = performance.throws().front();
  const auto phaseAfter = [&](double t) { return performance.at(t + 0.004).phase; };
  EXPECT_EQ(phaseAfter(truth.wind_up), Phase::kWindUp);
  EXPECT_EQ(phaseAfter(truth.stride), Phase::kStride);
  EXPECT_EQ(phaseAfter(truth.foot_contact), Phase::kArmCocking);
  EXPECT_EQ(phaseAfter(truth.max_external_rotation), Phase::kArmAcceleration);
  EXPECT_EQ(phaseAfter(truth.release), Phase::kArmDeceleration);
  EXPECT_EQ(phaseAfter(truth.max_internal_rotation), Phase::kFollowThrough);
}

TEST(Performance, LetsTheBallLeaveTheThrowingHandAtRelease) {
  for (const bool left : {false, true}) {
    auto options = doing({Action::kThrow});
    options.shape.left_handed = left;
    const Performance performance(3, options);
    const auto& truth = performance.throws().front();
    EXPECT_EQ(truth.left_handed, left);
    const auto before = performance.at(truth.release - 1e-4);
    const auto after = performance.at(truth.release + 1e-4);
    EXPECT_EQ(before.ball_state, BallState::kHeld);
    EXPECT_EQ(after.ball_state, BallState::kFlying);
    EXPECT_LT((after.ball - before.ball).norm(), 0.02);
    const auto hand = left ? kLeftWrist : kRightWrist;
    EXPECT_LT((before.ball - before.joints[hand]).norm(), 0.25);
    const auto later = performance.at(truth.release + 0.2);
    EXPECT_GT(later.ball.y() - before.ball.y(), 1.0) << "towards the heading";
  }
}

TEST(Performance, ThrowsWhereItFaces) {
  auto options = doing({Action::kThrow});
  options.heading = 2.0;
  const Performance performance(3, options);
  const auto& truth = performance.throws().front();
  const Vector3d flown =
      performance.at(truth.release + 0.3).ball - performance.at(truth.release).ball;
  EXPECT_GT(flown.normalized().dot(Vector3d{-std::sin(2.0), std::cos(2.0), 0}), 0.9);
}

TEST(Performance, KeepsTheBallInRehearsalsAndAbortedThrows) {
  for (const Action kind : {Action::kSlowThrow, Action::kAbortedThrow}) {
    const Performance performance(5, doing({kind}));
    const auto& truth = performance.throws().front();
    EXPECT_EQ(truth.kind, kind);
    for (double t = truth.wind_up + 0.01; t < truth.end; t += 0.05) {
      EXPECT_EQ(performance.at(t).ball_state, BallState::kHeld);
    }
  }
}

TEST(Performance, RehearsesAtAThirdOfTheSpeed) {
  const Performance fast(5, doing({Action::kThrow}));
  const Performance slow(5, doing({Action::kSlowThrow}));
  const auto seconds = [](const ThrowTruth& t) { return (t.release - t.foot_contact) * t.speed; };
  EXPECT_NEAR(seconds(slow.throws().front()) / seconds(fast.throws().front()), 3.0, 0.1);
}

TEST(Performance, CatchesWhatFliesIntoItsHands) {
  const Performance performance(9, doing({Action::kCatch, Action::kThrow}));
  double caught = 0;
  for (double t = 0; t < performance.duration() && caught <= 0; t += 0.001) {
    if (performance.at(t).ball_state == BallState::kFlying &&
        performance.at(t + 0.001).ball_state == BallState::kHeld) {
      caught = t;
    }
  }
  ASSERT_GT(caught, 0);
  const auto last = performance.at(caught);
  const auto first = performance.at(caught + 0.001);
  EXPECT_LT((last.ball - first.ball).norm(), 0.05);
  EXPECT_EQ(first.phase, Phase::kCatch);
}

TEST(Performance, WalksAlongTheRouteItIsGiven) {
  auto options = doing({Action::kWalk}, 10);
  options.route = {{0, 2}, {3, 2}, {3, -1}, {0, 0}};
  const Performance performance(2, options);
  std::vector<Vector2d> corners{options.home};
  corners.insert(corners.end(), options.route.begin(), options.route.end());
  corners.push_back(options.route.front());
  for (double t = 0; t < performance.duration(); t += 0.1) {
    const Vector2d at = hips(performance.at(t)).head<2>();
    double nearest = 9;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      const Vector2d ab = corners[i + 1] - corners[i];
      const double x = std::clamp((at - corners[i]).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (at - corners[i] - ab * x).norm());
    }
    EXPECT_LT(nearest, 0.75) << "at " << t;
  }
  double east = 0;
  for (double t = 0; t < performance.duration(); t += 0.1) {
    east = std::max(east, hips(performance.at(t)).x());
  }
  EXPECT_GT(east, 2.5);
}

TEST(Performance, RunsFasterThanItWalksAndLeavesTheFloor) {
  const Performance walk(6, doing({Action::kWalk}, 8));
  const Performance run(6, doing({Action::kRun}, 8));
  const auto fastest = [](const Performance& p) {
    double best = 0;
    for (double t = 0.1; t < p.duration(); t += 0.02) {
      best = std::max(best, (hips(p.at(t + 0.1)) - hips(p.at(t - 0.1))).head<2>().norm() / 0.2);
    }
    return best;
  };
  EXPECT_GT(fastest(walk), 0.9);
  EXPECT_LT(fastest(walk), 1.9);
  EXPECT_GT(fastest(run), 2.1);
  EXPECT_LT(fastest(run), 5.0);
}

TEST(Performance, PractisesEverythingWhenNothingIsAsked) {
  PerformanceOptions options;
  options.least_duration_s = 70;
  const Performance performance(11, options);
  for (const Action action :
       {Action::kStand, Action::kWalk, Action::kRun, Action::kThrow, Action::kSlowThrow,
        Action::kAbortedThrow, Action::kCatch, Action::kStretch}) {
    EXPECT_TRUE(std::ranges::any_of(performance.actions(), [&](const auto& a) {
      return a.action == action;
    })) << name(action);
  }
  EXPECT_GE(performance.duration(), 70);
  double last = 0;
  for (const auto& action : performance.actions()) {
    EXPECT_DOUBLE_EQ(action.from, last);
    EXPECT_GT(action.to, action.from);
    last = action.to;
  }
}

TEST(Performance, VariesItsThrows) {
  const Performance performance(13, doing({Action::kThrow}, 40));
  const auto& throws = performance.throws();
  ASSERT_GE(throws.size(), 6U);
  const auto [slowest, fastest] = std::ranges::minmax_element(throws, {}, &ThrowTruth::speed);
  const auto [lowest, highest] = std::ranges::minmax_element(throws, {}, &ThrowTruth::height);
  EXPECT_GT(fastest->speed - slowest->speed, 0.1);
  EXPECT_GT(highest->height - lowest->height, 0.5);
}

TEST(DrawShape, StaysWithinWhatPeopleAre) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto shape = drawShape(seed);
    EXPECT_GE(shape.height_m, 1.5);
    EXPECT_LE(shape.height_m, 2.05);
    EXPECT_GE(shape.skin.minCoeff(), 0.02F);
    EXPECT_LE(shape.shirt.maxCoeff(), 1.0F);
    EXPECT_GE(shape.number, 0);
    EXPECT_LE(shape.number, 99);
  }
}

}  // namespace
}  // namespace emulator::studio

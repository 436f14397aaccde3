#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "hal/emulated/studio/athlete/ball_flight.h"
#include "hal/emulated/studio/athlete/curve.h"

namespace emulator::studio {
namespace {

Curve zigzag() {
  Curve curve;
  double value = 0;
  for (int i = 0; i < 12; ++i) {
    curve.key(0.12 * i + 0.01 * (i % 3), value);
    value += i % 4 == 3 ? -1.5 : 0.7 * (i % 3);
  }
  return curve;
}

TEST(Curve, GoesThroughItsKeysAndRestsOutside) {
  Curve curve;
  EXPECT_EQ(curve.at(5), 0);
  curve.key(1, 2);
  curve.key(2, 5);
  EXPECT_EQ(curve.at(0), 2);
  EXPECT_EQ(curve.at(1), 2);
  EXPECT_DOUBLE_EQ(curve.at(2), 5);
  EXPECT_EQ(curve.at(9), 5);
}

TEST(Curve, NeverLeavesTheRangeOfItsNeighbouringKeys) {
  Curve curve;
  curve.key(0, 0);
  curve.key(1, 0.1);
  curve.key(1.05, 3);
  curve.key(2, 3.1);
  double last = 0;
  for (double t = 0; t <= 2; t += 0.001) {
    EXPECT_GE(curve.at(t), last - 1e-12) << "at " << t;
    last = curve.at(t);
  }
}

TEST(Curve, HasVelocityAndAccelerationWithoutJumps) {
  const Curve curve = zigzag();
  constexpr double kStep = 1e-4;
  const auto velocity = [&](double t) {
    return (curve.at(t + kStep) - curve.at(t - kStep)) / (2 * kStep);
  };
  const auto acceleration = [&](double t) {
    return (curve.at(t + kStep) - 2 * curve.at(t) + curve.at(t - kStep)) / (kStep * kStep);
  };
  for (double t = 0.01; t < 1.4; t += 0.0005) {
    EXPECT_NEAR(velocity(t), velocity(t + 0.0005), 0.5) << "at " << t;
    EXPECT_NEAR(acceleration(t), acceleration(t + 0.0005), 60) << "at " << t;
  }
}

TEST(Curve, ReplacesKeysThatALaterOneGoesBackBehind) {
  Curve curve;
  curve.key(0, 0);
  curve.key(1, 1);
  curve.key(0.5, 7);
  EXPECT_EQ(curve.last(), 7);
  EXPECT_EQ(curve.at(1), 7);
}

TEST(BallFlight, ArrivesWhereAndWhenItIsThrownTo) {
  const Eigen::Vector3d from{0, 7, 1.4};
  const Eigen::Vector3d to{0.2, 0.4, 1.2};
  const BallFlight flight{1.0, 1.6, from, launchVelocity(from, to, 0.6), 0.09};
  EXPECT_LT((flight.at(1.0) - from).norm(), 1e-9);
  EXPECT_LT((flight.at(1.6) - to).norm(), 1e-9);
}

TEST(BallFlight, BouncesLowerEachTimeAndNeverSinksIn) {
  const BallFlight flight{0, 5, {0, 0, 2}, {1, 0, 0}, 0.09};
  double highest_late = 0;
  double last_z = 2;
  for (double t = 0; t < 5; t += 0.002) {
    const auto p = flight.at(t);
    EXPECT_GE(p.z(), 0.09 - 1e-6);
    EXPECT_LT(std::abs(p.z() - last_z), 0.02) << "the ball jumps at " << t;
    last_z = p.z();
    if (t > 1.2) highest_late = std::max(highest_late, p.z());
  }
  EXPECT_LT(highest_late, 1.0);
}

}  // namespace
}  // namespace emulator::studio

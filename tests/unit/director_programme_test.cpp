#include <chrono>

#include <gtest/gtest.h>

#include "appliance/director/programme.h"

namespace {

using appliance::Cue;
using appliance::Programme;
using appliance::Rate;
using std::chrono::milliseconds;
using std::chrono::seconds;

const rt::Timestamp kStart = rt::fromNs(1'000'000'000);

TEST(Programme, StopsAtAMomentWalksHoldsAndGoesOnMoreSlowly) {
  Programme programme;
  ASSERT_TRUE(programme.add({.trigger = 100,
                             .angle_deg = 30,
                             .speed_deg_per_s = 30,
                             .hold = milliseconds(500),
                             .rate = Rate::kQuarter}));
  programme.start(0);
  auto step = programme.step(kStart, 99);
  EXPECT_EQ(step.rate, Rate::kFull);
  EXPECT_FALSE(step.angle_deg.has_value());
  const rt::Timestamp reached = kStart + milliseconds(25);
  step = programme.step(reached, 100);
  EXPECT_EQ(step.rate, Rate::kStill);
  EXPECT_DOUBLE_EQ(*step.angle_deg, 0);
  EXPECT_DOUBLE_EQ(*programme.step(reached + milliseconds(500), 100).angle_deg, 15);
  step = programme.step(reached + milliseconds(1499), 100);
  EXPECT_EQ(step.rate, Rate::kStill);
  EXPECT_FALSE(step.ended);
  step = programme.step(reached + milliseconds(1500), 100);
  EXPECT_EQ(step.rate, Rate::kQuarter);
  EXPECT_DOUBLE_EQ(*step.angle_deg, 30);
  EXPECT_TRUE(step.ended);
}

TEST(Programme, ALateStepStretchesNothing) {
  Programme programme;
  for (const double angle_deg : {10.0, 0.0, 5.0}) {
    ASSERT_TRUE(programme.add({.trigger = 7,
                               .angle_deg = angle_deg,
                               .speed_deg_per_s = 10,
                               .hold = rt::Nanoseconds::zero(),
                               .rate = Rate::kStill}));
  }
  programme.start(5);
  (void)programme.step(kStart, 7);
  EXPECT_DOUBLE_EQ(*programme.step(kStart + milliseconds(1700), 7).angle_deg, 2);
  const auto last = programme.step(kStart + milliseconds(2000), 7);
  EXPECT_TRUE(last.ended);
  EXPECT_DOUBLE_EQ(*last.angle_deg, 5);
}

TEST(Programme, TheViewMayMoveWhileTimeRuns) {
  Programme programme;
  ASSERT_TRUE(
      programme.add({.trigger = 10, .angle_deg = 20, .speed_deg_per_s = 10, .rate = Rate::kHalf}));
  ASSERT_TRUE(programme.add({.trigger = 20, .rate = Rate::kEighth}));
  programme.start(0);
  auto step = programme.step(kStart, 10);
  EXPECT_EQ(step.rate, Rate::kHalf);
  step = programme.step(kStart + seconds(1), 20);
  EXPECT_EQ(step.rate, Rate::kEighth);
  EXPECT_DOUBLE_EQ(*step.angle_deg, 10) << "the second cue does not stop the move";
  EXPECT_FALSE(step.ended);
  EXPECT_TRUE(programme.step(kStart + seconds(2), 21).ended);
}

TEST(Programme, RefusesTheCueThatDoesNotFit) {
  Programme programme;
  for (std::size_t i = 0; i < Programme::kMostCues; ++i) ASSERT_TRUE(programme.add(Cue{}));
  EXPECT_FALSE(programme.add(Cue{}));
}

}  // namespace

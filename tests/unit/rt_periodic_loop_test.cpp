#include <gtest/gtest.h>

#include "rt/periodic_loop.h"

namespace {

using namespace std::chrono_literals;
using rt::fromNs;
using rt::PeriodicSchedule;

constexpr auto kFirst = fromNs(1'000'000'000);
constexpr rt::Nanoseconds kPeriod = 25ms;

/// The turn that must be due at @p now.
rt::PeriodicTick mustWake(PeriodicSchedule& schedule, rt::Timestamp now) {
  const auto tick = schedule.wake(now);
  EXPECT_TRUE(tick.has_value());
  return tick.value_or(rt::PeriodicTick{});
}

TEST(PeriodicSchedule, RunsOneTurnPerDeadlineOnAGridThatDoesNotDrift) {
  PeriodicSchedule schedule(kFirst, kPeriod);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    ASSERT_EQ(schedule.deadline(), kFirst + i * kPeriod);
    const auto tick = mustWake(schedule, schedule.deadline() + 80us);
    EXPECT_EQ(tick.index, i);
    EXPECT_EQ(tick.deadline, kFirst + i * kPeriod);
    EXPECT_EQ(tick.lateness, 80us);
    EXPECT_EQ(tick.missed, 0u);
  }
}

TEST(PeriodicSchedule, GoesBackToSleepWhenWokenEarly) {
  PeriodicSchedule schedule(kFirst, kPeriod);
  EXPECT_FALSE(schedule.wake(kFirst - 1ns).has_value());
  EXPECT_EQ(schedule.deadline(), kFirst);
  EXPECT_EQ(schedule.missed(), 0u);
}

TEST(PeriodicSchedule, SkipsAndCountsMissedDeadlinesInsteadOfBursting) {
  PeriodicSchedule schedule(kFirst, kPeriod);
  const auto late = mustWake(schedule, kFirst + 3 * kPeriod + 1ms);
  EXPECT_EQ(late.index, 3u);
  EXPECT_EQ(late.deadline, kFirst + 3 * kPeriod);
  EXPECT_EQ(late.lateness, 1ms);
  EXPECT_EQ(late.missed, 3u);
  EXPECT_FALSE(schedule.wake(kFirst + 3 * kPeriod + 2ms).has_value());  // no second turn

  const auto next = mustWake(schedule, kFirst + 4 * kPeriod);
  EXPECT_EQ(next.index, 4u);
  EXPECT_EQ(next.missed, 0u);
  EXPECT_EQ(schedule.missed(), 3u);
}

TEST(PeriodicSchedule, GivesUpADeadlineBeyondItsLatestLateness) {
  PeriodicSchedule schedule(kFirst, kPeriod, 2ms);
  EXPECT_FALSE(schedule.wake(kFirst + 2ms + 1ns).has_value());
  EXPECT_EQ(schedule.deadline(), kFirst + kPeriod);
  EXPECT_EQ(schedule.missed(), 1u);

  const auto next = mustWake(schedule, kFirst + kPeriod + 2ms);
  EXPECT_EQ(next.missed, 1u);  // the turn knows what was lost before it
}

TEST(PeriodicSchedule, NudgeMovesAllComingDeadlines) {
  PeriodicSchedule schedule(kFirst, kPeriod);
  schedule.nudge(-300us);
  EXPECT_EQ(schedule.deadline(), kFirst - 300us);
  ASSERT_TRUE(schedule.wake(schedule.deadline()).has_value());
  EXPECT_EQ(schedule.deadline(), kFirst - 300us + kPeriod);
}

TEST(PeriodicLoop, WakesAtItsDeadlinesAndNeverBefore) {
  const auto begin = rt::now();
  rt::PeriodicLoop loop(PeriodicSchedule(begin + 1ms, 2ms));
  std::uint64_t served = 0;
  std::uint64_t lost = 0;
  std::uint64_t last_index = 0;
  while (served < 10) {
    const auto tick = loop.wait();
    if (!tick) continue;
    EXPECT_GE(rt::now(), tick->deadline);
    EXPECT_EQ(tick->deadline, begin + 1ms + tick->index * rt::Nanoseconds(2ms));
    ++served;
    lost += tick->missed;
    last_index = tick->index;
  }
  EXPECT_EQ(served + lost, last_index + 1);  // every deadline was served or counted
}

TEST(SleepUntil, ReturnsAtOnceForAnInstantThatHasPassed) {
  rt::sleepUntil(rt::now() - 1h);
  rt::sleepUntil(fromNs(-5));
  SUCCEED();  // hanging is the failure; ctest's timeout finds it
}

}  // namespace

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/simulated_screen.h"
#include "ui-kms/frame_pacer.h"

namespace {

using namespace std::chrono_literals;
using rt::Nanoseconds;
using rt::Timestamp;
using ui::FramePacer;

constexpr Timestamp kStart = rt::fromNs(7'000'000'000'000);

double errorUs(const FramePacer& pacer, const SimulatedScreen& screen, std::uint64_t vblank) {
  return static_cast<double>((pacer.timing()->vblankAt(vblank) - screen.truly(vblank)).count()) /
         1e3;
}

/// Feeds every @p step th vblank from @p from on, @p count of them; the vblank after the last.
std::uint64_t feed(FramePacer& pacer, SimulatedScreen& screen, std::uint64_t from, int count,
                   std::uint64_t step = 1) {
  for (int i = 0; i < count; ++i, from += step)
    pacer.onVblank(from, screen.flip(1, from).page_flip);
  return from;
}

TEST(FramePacer, KnowsNothingBeforeThirteenVblanks) {
  SimulatedScreen screen({}, 0, kStart, 1);
  FramePacer pacer(60);
  std::uint64_t next = feed(pacer, screen, 100, 12);
  EXPECT_FALSE(pacer.timing().has_value());
  feed(pacer, screen, next, 1);
  EXPECT_TRUE(pacer.timing().has_value());
}

TEST(FramePacer, PredictsAnExactGridExactly) {
  SimulatedScreen screen({.nominal_hz = 59.94}, 0, kStart, 1);
  FramePacer pacer(60);
  feed(pacer, screen, 5, 300, 2);
  for (const std::uint64_t vblank : {605u, 700u, 1205u})
    EXPECT_LE(std::abs(errorUs(pacer, screen, vblank)), 0.5) << vblank;
  EXPECT_NEAR(pacer.timing()->period_ns, 1e9 / 59.94, 1);
  EXPECT_LE(pacer.timing()->stamp_jitter_ns, 3e3);
}

TEST(FramePacer, AveragesTheJitterOfStampsAndTellsIt) {
  SimulatedScreen screen({.nominal_hz = 60, .off_ppm = 200}, 50e3, kStart, 2);
  FramePacer pacer(60);
  std::uint64_t next = feed(pacer, screen, 0, 120);
  double squares = 0;
  for (int i = 0; i < 3000; ++i) {
    next = feed(pacer, screen, next, 1);
    const double error = errorUs(pacer, screen, next);
    squares += error * error;
  }
  EXPECT_LE(std::sqrt(squares / 3000), 8);
  EXPECT_NEAR(pacer.timing()->stamp_jitter_ns, 50e3, 12e3);
}

TEST(FramePacer, LosesNothingButTimeWhenEventsAreLost) {
  SimulatedScreen screen({.nominal_hz = 80, .off_ppm = -200}, 50e3, kStart, 3);
  FramePacer pacer(80);
  std::uint64_t next = feed(pacer, screen, 0, 400);
  next = feed(pacer, screen, next + 80, 1);  // a second of silence
  EXPECT_LE(std::abs(errorUs(pacer, screen, next)), 30);
  next = feed(pacer, screen, next + 800, 1);
  EXPECT_LE(std::abs(errorUs(pacer, screen, next)), 60);
  feed(pacer, screen, next, 100, 3);
  EXPECT_LE(std::abs(errorUs(pacer, screen, next + 300)), 30);
}

TEST(FramePacer, KnowsThePhaseStillAfterAMinuteOfSilence) {
  double squares = 0;
  constexpr std::uint32_t kScreens = 100;
  for (std::uint32_t seed = 1; seed <= kScreens; ++seed) {
    SimulatedScreen screen({.nominal_hz = 60, .off_ppm = 100}, 50e3, kStart, seed);
    FramePacer pacer(60);
    const std::uint64_t next = feed(pacer, screen, 0, 1200);
    const double error = errorUs(pacer, screen, next + 3600);
    squares += error * error;
  }
  EXPECT_LE(std::sqrt(squares / kScreens), 150);
}

TEST(FramePacer, IsHardlyMovedByOneStampThatIsOff) {
  for (const Nanoseconds off : {Nanoseconds(3ms), Nanoseconds(-3ms), Nanoseconds(400us)}) {
    SimulatedScreen screen({}, 20e3, kStart, 4);
    FramePacer pacer(60);
    const std::uint64_t next = feed(pacer, screen, 0, 300);
    const double before = errorUs(pacer, screen, next);
    pacer.onVblank(next, screen.truly(next) + off);
    EXPECT_LE(std::abs(errorUs(pacer, screen, next + 1) - before), 2);
  }
}

TEST(FramePacer, DoesNotTrustTheStampOfTheFlipThatSetTheMode) {
  for (const Nanoseconds off : {Nanoseconds(1700us), Nanoseconds(-5ms), Nanoseconds(3s)}) {
    SimulatedScreen screen({}, 0, kStart, 5);
    FramePacer pacer(60);
    pacer.onVblank(7, screen.truly(7) + off);
    const std::uint64_t next = feed(pacer, screen, 8, 12);
    EXPECT_LE(std::abs(errorUs(pacer, screen, next)), 1);
  }
}

TEST(FramePacer, RecoversFromAnEarlyStampThatIsFarOff) {
  SimulatedScreen screen({}, 20e3, kStart, 5);
  FramePacer pacer(60);
  feed(pacer, screen, 0, 1);
  pacer.onVblank(1, screen.truly(1) + 5ms);
  const std::uint64_t next = feed(pacer, screen, 2, 40);
  EXPECT_LE(std::abs(errorUs(pacer, screen, next)), 40);
}

TEST(FramePacer, StartsAnewWhenTheVblankNumberJumpsBack) {
  SimulatedScreen before({.nominal_hz = 60}, 0, kStart, 6);
  SimulatedScreen after({.nominal_hz = 50}, 0, kStart + 20s, 6);
  FramePacer pacer(60);
  feed(pacer, before, 0, 200);
  pacer.restart(50);
  EXPECT_FALSE(pacer.timing().has_value());
  feed(pacer, after, 0, 40);
  EXPECT_NEAR(pacer.timing()->period_ns, 20e6, 5);

  feed(pacer, after, 1000, 1);
  feed(pacer, after, 999, 1);  // without a call of restart()
  EXPECT_FALSE(pacer.timing().has_value());
  feed(pacer, after, 1001, 12);
  EXPECT_LE(std::abs(errorUs(pacer, after, 1020)), 1);
}

TEST(FramePacer, StartsAnewWhenTheGridMovedUnderTheSameNumbers) {
  SimulatedScreen screen({}, 20e3, kStart, 7);
  SimulatedScreen moved({}, 20e3, kStart + 7ms, 8);
  FramePacer pacer(60);
  std::uint64_t next = feed(pacer, screen, 0, 300);
  next = feed(pacer, moved, next, 8);
  EXPECT_FALSE(pacer.timing().has_value());
  next = feed(pacer, moved, next, 30);
  EXPECT_LE(std::abs(errorUs(pacer, moved, next)), 40);
}

TEST(FramePacer, IgnoresAVblankItHasSeen) {
  SimulatedScreen screen({}, 0, kStart, 9);
  FramePacer pacer(60);
  const std::uint64_t next = feed(pacer, screen, 0, 50);
  pacer.onVblank(next - 1, screen.truly(next - 1) + 4ms);
  EXPECT_LE(std::abs(errorUs(pacer, screen, next)), 1);
}

TEST(FramePacer, FollowsAPeriodThatWanders) {
  SimulatedScreen screen({.nominal_hz = 60, .off_ppm = 200, .wander_ppm = 5, .wander_period_s = 60},
                         50e3, kStart, 10);
  FramePacer pacer(60);
  std::uint64_t next = feed(pacer, screen, 0, 120);
  for (int i = 0; i < 7200; ++i) {
    next = feed(pacer, screen, next, 1);
    ASSERT_LE(std::abs(errorUs(pacer, screen, next)), 40) << "vblank " << next;
  }
}

TEST(FramePacer, GivesTheLatestStartOfAWarp) {
  SimulatedScreen screen({.nominal_hz = 100}, 0, kStart, 11);
  FramePacer pacer(100, 300us);
  feed(pacer, screen, 0, 50);
  for (int i = 0; i < 100; ++i) pacer.onPicture({kStart, kStart, kStart + (i < 2 ? 90ms : 4ms)});
  const hal::DisplayTiming timing = *pacer.timing();
  EXPECT_EQ(timing.draw, 4ms);
  EXPECT_EQ(timing.latestStart(60), timing.vblankAt(60) - 4ms - 300us);
  EXPECT_NEAR(static_cast<double>(rt::toNs(timing.vblankAt(60))), rt::toNs(kStart) + 600e6, 1e3);
}

TEST(DisplayTiming, FindsTheFirstVblankAfterAnInstant) {
  const hal::DisplayTiming timing{.vblank = 1000, .at = kStart, .period_ns = 12.5e6};
  EXPECT_EQ(timing.firstVblankAfter(kStart - 1ns), 1000u);
  EXPECT_EQ(timing.firstVblankAfter(kStart), 1001u);
  EXPECT_EQ(timing.firstVblankAfter(kStart - 12500us), 1000u);
  EXPECT_EQ(timing.firstVblankAfter(kStart - 12501us), 999u);
  EXPECT_EQ(timing.firstVblankAfter(kStart + 25ms - 1ns), 1002u);
  EXPECT_EQ(timing.vblankAt(998), kStart - 25ms);
}

}  // namespace

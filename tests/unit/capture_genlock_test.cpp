#include <chrono>
#include <cstdlib>

#include <gtest/gtest.h>

#include "appliance/capture/genlock.h"

namespace {

using appliance::Genlock;
using appliance::GenlockReason;
using appliance::GenlockState;
using namespace std::chrono_literals;
using rt::Nanoseconds;
using rt::Timestamp;

constexpr Nanoseconds kPeriod = 25ms;  // 40 Hz on a screen of 80 Hz
constexpr Timestamp kStart = rt::fromNs(1'000'000'000'000);

hal::DisplayTiming screen(Timestamp at, double hz = 80) {
  return {.vblank = 1000,
          .at = at,
          .period_ns = 1e9 / hz,
          .stamp_jitter_ns = 10e3,
          .draw = 8ms,
          .commit_margin = 500us};
}

/// Steps a genlock as the trigger loop does, and keeps the deadlines.
struct Loop {
  explicit Loop(Timestamp first, bool enabled = true, Nanoseconds every = kPeriod)
      : genlock({.enabled = enabled, .period = every, .margin = 1500us}),
        period(every),
        deadline(first) {}

  Nanoseconds step() {
    deadline += period;
    const Nanoseconds moved = genlock.step(deadline);
    deadline += moved;
    return moved;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) (void)step();
  }
  /// Steps until locked; how many, or -1 after @p most.
  int lock(int most = 200) {
    for (int i = 1; i <= most; ++i) {
      (void)step();
      if (genlock.status().state == GenlockState::kLocked) return i;
    }
    return -1;
  }

  Genlock genlock;
  Nanoseconds period;
  Timestamp deadline;
};

TEST(Genlock, IsOffWhenNotAskedFor) {
  Loop loop(kStart, false);
  loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms});
  EXPECT_EQ(loop.step(), 0ns);
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kOff);
  EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kNone);
}

TEST(Genlock, RunsFreeUntilItKnowsVblanksAndFrames) {
  Loop loop(kStart);
  EXPECT_EQ(loop.step(), 0ns);
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kFreeRunning);
  EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kNoVblanks);
  loop.genlock.take({.timing = screen(kStart), .ready_delay = {}});
  EXPECT_EQ(loop.step(), 0ns);
  EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kNoFrames);
  loop.genlock.take({.timing = std::nullopt, .ready_delay = 12ms});
  EXPECT_NE(loop.step(), 0ns);
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kAcquiring);
  EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kNone);
  EXPECT_EQ(loop.genlock.status().vblanks_per_trigger, 2u);
}

TEST(Genlock, PutsTheFrameAMarginBeforeTheLatestStartOfItsWarp) {
  Loop loop(kStart + 3ms);
  const hal::DisplayTiming timing = screen(kStart);
  loop.genlock.take({.timing = timing, .ready_delay = 12ms});
  ASSERT_GT(loop.lock(), 0);
  const Timestamp ready = loop.deadline + 12ms;
  const std::uint64_t vblank = timing.firstVblankAfter(ready + 9ms);
  EXPECT_EQ(timing.latestStart(vblank) - ready, 1500us);
  EXPECT_EQ(loop.genlock.status().lead, 12ms + 1500us + 8ms + 500us);
  EXPECT_EQ(loop.genlock.status().phase_error, 0ns);
}

TEST(Genlock, MovesAtMostOnePerCentPerTriggerAndTheShorterWay) {
  for (Nanoseconds phase = 0ms; phase < kPeriod; phase += 250us) {
    Loop loop(kStart + phase);
    loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms});
    Nanoseconds sum{};
    for (int i = 0; i < 40; ++i) {
      const Nanoseconds moved = loop.step();
      ASSERT_LE(std::chrono::abs(moved), kPeriod / 100) << "phase " << phase.count();
      sum += moved;
    }
    EXPECT_LE(std::chrono::abs(sum), 12500us / 2) << "half a vblank is as far as it can be";
    EXPECT_EQ(loop.genlock.status().state, GenlockState::kLocked);
  }
}

TEST(Genlock, FollowsARefreshRateThatIsNotQuiteAMultiple) {
  Loop loop(kStart, true, Nanoseconds(16'666'667));
  loop.genlock.take({.timing = screen(kStart, 59.94), .ready_delay = 12ms});
  ASSERT_GT(loop.lock(), 0);
  EXPECT_NEAR(static_cast<double>(loop.step().count()), 1e9 / 59.94 - 16'666'667, 2);
  EXPECT_EQ(loop.genlock.status().vblanks_per_trigger, 1u);
}

TEST(Genlock, RefusesARateThatDoesNotDivideTheRefreshRate) {
  for (const double hz : {60.0, 30.0, 80.5, 79.5}) {
    Loop loop(kStart);
    loop.genlock.take({.timing = screen(kStart, hz), .ready_delay = 12ms});
    EXPECT_EQ(loop.step(), 0ns);
    EXPECT_EQ(loop.genlock.status().state, GenlockState::kFreeRunning) << hz;
    EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kRatio) << hz;
    EXPECT_NEAR(loop.genlock.status().vblank_period_ns, 1e9 / hz, 1e-3);
  }
  for (const double hz : {80.3, 79.7, 40.0, 120.0, 240.0}) {
    Loop loop(kStart);
    loop.genlock.take({.timing = screen(kStart, hz), .ready_delay = 12ms});
    EXPECT_GT(loop.lock(), 0) << hz;
  }
}

TEST(Genlock, UnlocksAndSaysWhyWhenTheVblanksAreElsewhere) {
  Loop loop(kStart);
  loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms});
  ASSERT_GT(loop.lock(), 0);
  loop.genlock.take({.timing = screen(kStart + 2ms), .ready_delay = 12ms});
  (void)loop.step();
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kAcquiring);
  EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kPhaseLost);
  EXPECT_EQ(loop.genlock.status().unlocks, 1u);
  ASSERT_GT(loop.lock(), 0);
  EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kNone);
  EXPECT_EQ(loop.genlock.status().last_unlock, GenlockReason::kPhaseLost);
  EXPECT_EQ(loop.genlock.status().unlocks, 1u);
}

TEST(Genlock, UnlocksWhenTheScreenChangesItsRate) {
  Loop loop(kStart);
  loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms});
  ASSERT_GT(loop.lock(), 0);
  loop.genlock.take({.timing = screen(loop.deadline, 60), .ready_delay = 12ms});
  EXPECT_EQ(loop.step(), 0ns);
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kFreeRunning);
  EXPECT_EQ(loop.genlock.status().last_unlock, GenlockReason::kRatio);
}

TEST(Genlock, HoldsOverSilenceAndGivesUpAfterAMinute) {
  Loop loop(kStart);
  loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms});
  ASSERT_GT(loop.lock(), 0);
  while (loop.deadline < kStart + 59s) {
    loop.genlock.take({.timing = std::nullopt, .ready_delay = 12ms});
    (void)loop.step();
  }
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kLocked);
  EXPECT_TRUE(loop.genlock.status().hold_over);
  loop.steps(80);
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kFreeRunning);
  EXPECT_EQ(loop.genlock.status().reason, GenlockReason::kNoVblanks);
  EXPECT_FALSE(loop.genlock.status().hold_over);
  EXPECT_EQ(loop.genlock.status().unlocks, 1u);
}

TEST(Genlock, LetsLeadFollowSlowlyWithoutLosingTheLock) {
  Loop loop(kStart);
  loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms});
  ASSERT_GT(loop.lock(), 0);
  const Nanoseconds lead = loop.genlock.status().lead;

  loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms + 300us});
  loop.steps(100);
  EXPECT_EQ(loop.genlock.status().lead, lead) << "a part of the margin is slack";

  for (const Nanoseconds change : {Nanoseconds(4ms), Nanoseconds(-3ms)}) {
    loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms + change});
    for (int i = 0; i < 200; ++i) {
      EXPECT_LE(std::chrono::abs(loop.step()), 50us);
      ASSERT_EQ(loop.genlock.status().state, GenlockState::kLocked);
      ASSERT_LE(std::chrono::abs(loop.genlock.status().phase_error), 1us);
    }
    EXPECT_EQ(loop.genlock.status().lead, lead + change);
  }
  EXPECT_EQ(loop.genlock.status().unlocks, 0u);
}

TEST(Genlock, KeepsItsPhaseOverTriggersThatWereGivenUp) {
  Loop loop(kStart);
  loop.genlock.take({.timing = screen(kStart), .ready_delay = 12ms});
  ASSERT_GT(loop.lock(), 0);
  loop.deadline += 4 * kPeriod;  // the thread did not run for 100 ms
  loop.steps(1);
  EXPECT_EQ(loop.genlock.status().state, GenlockState::kLocked);
  EXPECT_EQ(loop.genlock.status().phase_error, 0ns);
}

}  // namespace

#include <memory>

#include <gtest/gtest.h>

#include "appliance/capture/trigger_matcher.h"

namespace {

using namespace std::chrono_literals;
using appliance::Association;
using appliance::CameraPace;
using appliance::EdgeBoard;
using appliance::MatchedTrigger;
using appliance::TriggerMatcher;
using Why = MatchedTrigger::Why;

constexpr rt::Nanoseconds kPeriod = 25ms;
constexpr rt::Nanoseconds kDelay = 1ms;

/// A trigger every 25 ms and a camera that follows, on a machine that looks some time after.
class TriggerMatcherTest : public testing::Test {
 protected:
  static rt::Timestamp edge(std::uint64_t trigger) {
    return rt::fromNs(5'000'000'000'000) + static_cast<std::int64_t>(trigger) * kPeriod;
  }
  /// The next trigger fires; the camera's answer is the caller's affair.
  void fire() {
    ++trigger_;
    edges_->post(trigger_, edge(trigger_));
    clock_ += kPeriod + drift_;
  }
  /// The camera sends what it took at @p clock, looked at @p late after it could arrive.
  MatchedTrigger send(rt::Nanoseconds clock, rt::Nanoseconds late) {
    return matcher_.match({.arrival = edge(trigger_) + kDelay + late,
                           .camera_clock = has_clock_ ? clock : 0ns,
                           .frame_id = ++frame_id_},
                          *edges_);
  }
  MatchedTrigger next(rt::Nanoseconds late = 100us) {
    fire();
    return send(clock_, late);
  }
  /// The trigger named for the newest one's frame: 0 for none.
  std::uint64_t named(rt::Nanoseconds late = 100us) { return next(late).trigger; }
  void settle(int frames = 20) {
    for (int i = 0; i < frames; ++i) (void)next();
  }

  std::unique_ptr<EdgeBoard> edges_ = std::make_unique<EdgeBoard>();
  TriggerMatcher matcher_{Association{kPeriod, kDelay}};
  bool has_clock_ = true;
  rt::Nanoseconds clock_ = 1234s;  // the camera was switched on some time ago
  rt::Nanoseconds drift_{0};       // of its clock, per period
  std::uint64_t trigger_ = 0;
  std::uint64_t frame_id_ = 500;
};

TEST_F(TriggerMatcherTest, HasNoDoubtFromTheFirstTriggerOn) {
  for (std::uint64_t trigger = 1; trigger < 20; ++trigger) EXPECT_EQ(named(), trigger);
}

TEST_F(TriggerMatcherTest, HasNoDoubtOfTheFirstTriggerWhenItIsAskedAfterTheSecond) {
  fire();
  const rt::Nanoseconds first = clock_;
  fire();  // the first frame's leader was seen in time, its end comes only now
  EXPECT_EQ(send(first, 100us - kPeriod).trigger, 1U);
  EXPECT_EQ(send(clock_, 100us).trigger, 2U);
}

TEST_F(TriggerMatcherTest, DoubtsAFirstFrameThatTheSecondTriggerCanHaveBrought) {
  fire();
  fire();
  EXPECT_EQ(send(clock_, 13ms - kPeriod).why, Why::kUnsettled);
}

TEST_F(TriggerMatcherTest, NeedsThreeFramesOfACameraThatJoinsLater) {
  for (int i = 0; i < 10; ++i) fire();
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(named(), 13U);
}

TEST_F(TriggerMatcherTest, IsNotFooledByAFirstFrameThatCameAPeriodLate) {
  for (int i = 0; i < 10; ++i) fire();
  const rt::Nanoseconds first = clock_;
  fire();
  EXPECT_EQ(send(first, 0us).why, Why::kUnsettled);
  EXPECT_EQ(send(clock_, 10ms).why, Why::kUnsettled);
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, NamesAFrameHoweverLateTheMachineLooks) {
  settle();
  for (const rt::Nanoseconds late : {300'000ns, rt::Nanoseconds(12ms), rt::Nanoseconds(13ms),
                                     rt::Nanoseconds(25ms), rt::Nanoseconds(400ms)}) {
    EXPECT_EQ(named(late), trigger_) << late.count();
  }
}

TEST_F(TriggerMatcherTest, NamesALateLeaderByItsClockAmongFramesInTime) {
  settle();
  fire();
  const rt::Nanoseconds late_clock = clock_;
  fire();  // the late frame arrives when the next one should
  EXPECT_EQ(send(late_clock, 0us).trigger, trigger_ - 1);
  EXPECT_EQ(send(clock_, 11ms).trigger, trigger_);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, FollowsACameraThatIgnoresTriggers) {
  settle();
  fire();
  EXPECT_EQ(named(), trigger_);
  for (int i = 0; i < 10; ++i) {  // every second one
    fire();
    EXPECT_EQ(named(), trigger_);
  }
}

TEST_F(TriggerMatcherTest, DropsAFrameThatNothingAskedForAndNoOther) {
  settle();
  for (const rt::Nanoseconds after : {5ms, 11ms, 14ms, 23ms}) {
    ASSERT_EQ(named(), trigger_);
    EXPECT_EQ(send(clock_ + after, after).why, Why::kNoEdge) << after.count();
  }
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, FollowsAClockThatDrifts) {
  for (const rt::Nanoseconds drift : {2500ns, -2500ns}) {  // 100 ppm either way
    drift_ = drift;
    for (int i = 0; i < 4000; ++i) {
      ASSERT_EQ(named(i % 3 == 0 ? 100us : 30ms), trigger_) << i;
    }
  }
}

TEST_F(TriggerMatcherTest, SettlesAnewWithinThreeFramesOfARestartedClock) {
  settle();
  clock_ = 0s;
  frame_id_ = 0;
  EXPECT_EQ(named(), 0U);
  EXPECT_EQ(named(), 0U);
  EXPECT_EQ(named(), trigger_);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, IsNotFooledByAClockThatWasSetByWholePeriods) {
  for (const rt::Nanoseconds step : {-kPeriod, kPeriod, -3 * kPeriod, 3 * kPeriod}) {
    settle();
    clock_ += step;
    for (int i = 0; i < 5; ++i) {
      const std::uint64_t trigger = named();
      EXPECT_TRUE(trigger == 0 || trigger == trigger_) << step.count() << ' ' << i;
      if (i >= 2) {
        EXPECT_EQ(trigger, trigger_) << step.count();
      }
    }
  }
}

TEST_F(TriggerMatcherTest, LosesTwoFramesToIdsThatJump) {
  settle();
  frame_id_ += 40'000;
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, LosesNothingToFramesThatWereLostOnTheWire) {
  settle();
  for (int i = 0; i < 4; ++i) {
    fire();
    ++frame_id_;
  }
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, GivesUpAWrongClockWhenAFrameComesBeforeItsTrigger) {
  for (int i = 0; i < 10; ++i) fire();
  MatchedTrigger last;
  for (int i = 0; i < 3; ++i) {  // all that it sees comes a period late
    const rt::Nanoseconds before = clock_;
    fire();
    last = send(before, 0us);
  }
  ASSERT_EQ(last.trigger, trigger_) << "it cannot know better";
  EXPECT_EQ(send(clock_, 10ms).trigger, 0U);
  EXPECT_EQ(named(), 0U);
  EXPECT_EQ(named(), trigger_);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, ForgetsTheClockInALongSilence) {
  settle();
  for (int i = 0; i < 10'000; ++i) fire();  // 250 s, in which 100 ppm make one period
  clock_ += kPeriod;
  EXPECT_EQ(named(), 0U);
  EXPECT_EQ(named(), 0U);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, StartsAnewWhenTold) {
  settle();
  matcher_.restart();
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, NamesByArrivalWhereThereIsNoClock) {
  has_clock_ = false;
  for (int i = 0; i < 100; ++i) ASSERT_EQ(named(i % 2 == 0 ? 100us : 12ms), trigger_);
  EXPECT_EQ(next(13ms).why, Why::kNoEdge);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, DropsALateLeaderWithoutAClockInsteadOfGuessing) {
  has_clock_ = false;
  settle();
  fire();
  fire();
  EXPECT_EQ(send(0s, 0us).why, Why::kUnsettled);  // the one before, a period late
  EXPECT_EQ(send(0s, 11ms).trigger, trigger_);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, RepairsASlipWithoutAClockWithinThreeFrames) {
  has_clock_ = false;
  settle();
  fire();  // ignored by the camera
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(next().why, Why::kUnsettled);
  EXPECT_EQ(named(), trigger_);
}

TEST_F(TriggerMatcherTest, TakesTheNearestTriggerOfACameraThatRunsFree) {
  matcher_ = TriggerMatcher(Association{kPeriod, kDelay, CameraPace::kFreeRunning});
  fire();
  for (int i = 0; i < 100; ++i) {
    fire();
    EXPECT_EQ(send(clock_, i * 100us).trigger, trigger_);
  }
}

TEST_F(TriggerMatcherTest, NamesAFrameWhoseTriggersEdgeIsNotKnownWell) {
  settle();
  for (int i = 0; i < 5; ++i) {
    // The trigger loop was stopped for 6 ms while it drove the line: the edge left immediately.
    ++trigger_;
    edges_->post(trigger_, edge(trigger_) + 3ms, 3ms);
    clock_ += kPeriod;
    EXPECT_EQ(send(clock_, 100us).trigger, trigger_);
    EXPECT_EQ(named(), trigger_) << "and the clock is as it was";
  }
}

/// Names the frames of a camera that joins at trigger 5, at any rate.
class TriggerMatcherAtAnyRate : public testing::TestWithParam<rt::Nanoseconds> {};

TEST_P(TriggerMatcherAtAnyRate, NamesEveryFrameOnceItIsSettled) {
  const rt::Nanoseconds period = GetParam();
  const rt::Nanoseconds delay = period / 10;
  const auto edges = std::make_unique<EdgeBoard>();
  TriggerMatcher matcher{Association{period, delay}};
  for (std::uint64_t trigger = 1; trigger <= 100; ++trigger) {
    const rt::Timestamp edge = rt::fromNs(5'000'000'000'000) + static_cast<int>(trigger) * period;
    edges->post(trigger, edge);
    if (trigger < 5) continue;
    const rt::Nanoseconds late = period / 20 * static_cast<int>(trigger % 7);
    const MatchedTrigger name = matcher.match({.arrival = edge + delay + late,
                                               .camera_clock = edge - rt::fromNs(4'000'000'000'000),
                                               .frame_id = trigger},
                                              *edges);
    if (trigger >= 5 + TriggerMatcher::kAgreeing - 1) {
      EXPECT_EQ(name.trigger, trigger);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, TriggerMatcherAtAnyRate,
                         testing::Values(10s, 5s, 1s, 25ms, 10ms, 2ms, 1ms));

}  // namespace

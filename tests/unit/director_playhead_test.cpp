#include <chrono>

#include <gtest/gtest.h>

#include "appliance/director/playhead.h"

namespace {

using appliance::Playhead;
using appliance::Rate;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr rt::Nanoseconds kPeriod = milliseconds(25);

class APlayhead : public testing::Test {
 protected:
  std::uint64_t after(rt::Nanoseconds passed, rt::Nanoseconds refresh = {}) {
    now += passed;
    playhead.advance({.at = now, .refresh = refresh}, kPeriod);
    return playhead.trigger();
  }
  void startAt(std::uint64_t trigger, Rate rate) {
    (void)after(milliseconds(1));
    playhead.seek(trigger);
    playhead.setRate(rate);
  }

  Playhead playhead;
  rt::Timestamp now = rt::fromNs(1'000'000'000);
};

TEST_F(APlayhead, MovesByTimeAloneWhereNoVblanksAreKnown) {
  startAt(100, Rate::kHalf);
  EXPECT_EQ(after(milliseconds(49)), 100u);
  EXPECT_EQ(after(milliseconds(1)), 101u);
  EXPECT_EQ(after(seconds(1)), 121u);
}

TEST_F(APlayhead, StandsStillAtRateZeroAndDoesNotMakeUpForThatTime) {
  startAt(100, Rate::kStill);
  EXPECT_EQ(after(seconds(5)), 100u);
  playhead.setRate(Rate::kFull);
  EXPECT_EQ(after(milliseconds(25)), 101u);
}

TEST_F(APlayhead, AnInstantInThePastChangesNothing) {
  startAt(100, Rate::kFull);
  EXPECT_EQ(after(milliseconds(100)), 104u);
  EXPECT_EQ(after(milliseconds(-80)), 104u);
  EXPECT_EQ(after(milliseconds(80)), 104u);
  EXPECT_EQ(after(milliseconds(25)), 105u);
}

TEST_F(APlayhead, CountsVblanksWhateverTheirPredictionIsOffBy) {
  startAt(100, Rate::kHalf);
  const rt::Nanoseconds refresh = microseconds(12'500);
  for (int vblank = 1; vblank <= 40; ++vblank) {
    const rt::Nanoseconds off = microseconds(vblank % 2 == 0 ? 3000 : 0);
    Playhead copy = playhead;
    copy.advance({.at = now + vblank * refresh + off, .refresh = refresh}, kPeriod);
    playhead.advance({.at = now + vblank * refresh, .refresh = refresh}, kPeriod);
    EXPECT_EQ(copy.trigger(), playhead.trigger());
    EXPECT_EQ(playhead.trigger(), 100u + static_cast<unsigned>(vblank) / 4);
  }
}

TEST_F(APlayhead, FollowsAScreenThatIsALittleFasterThanTheTriggersWithoutASlip) {
  startAt(100, Rate::kFull);
  const rt::Nanoseconds refresh = microseconds(12'460);  // 0.3 % fast
  for (unsigned vblank = 1; vblank <= 4000; ++vblank)
    ASSERT_EQ(after(refresh, refresh), 100 + vblank / 2);
}

TEST_F(APlayhead, NearAMovingGoalIgnoresOneTriggerAndNeverGoesBack) {
  startAt(100, Rate::kFull);
  playhead.keepNear(101);
  EXPECT_EQ(playhead.trigger(), 100u);
  playhead.keepNear(102);
  EXPECT_EQ(playhead.trigger(), 101u);
  EXPECT_EQ(after(milliseconds(50)), 103u);
  playhead.keepNear(101);  // the frames stay away: it waits
  EXPECT_EQ(playhead.trigger(), 102u);
  EXPECT_EQ(after(milliseconds(25)), 103u);
  playhead.keepNear(101);
  EXPECT_EQ(playhead.trigger(), 102u);
  playhead.keepNear(200);
  EXPECT_EQ(playhead.trigger(), 200u);
}

}  // namespace

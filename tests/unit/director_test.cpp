#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/director_fixture.h"

namespace director_test {
namespace {

TEST_F(DirectorOnAnArcOfFive, ShowsNothingBeforeTheFirstFrameAndIgnoresFreezeThen) {
  history.newest = 0;
  EXPECT_EQ(tick().trigger, 0u);
  EXPECT_EQ(press(kFreezeToggle).mode, Mode::kLive);
  EXPECT_EQ(press(kSweep).mode, Mode::kLive);
  EXPECT_EQ(press(kStepBack).mode, Mode::kLive);
  EXPECT_EQ(press(kDelayMore).mode, Mode::kLive);
}

TEST_F(DirectorOnAnArcOfFive, LiveNeverStepsBackInTime) {
  history.newest = 1000;
  EXPECT_EQ(tick().trigger, 1000u);
  history.newest_of[2] = 0;
  struct Receding : FakeHistory {
    [[nodiscard]] StoredRange range(std::uint32_t) const noexcept override { return {701, 999}; }
    [[nodiscard]] bool holds(std::uint32_t, std::uint64_t trigger) const noexcept override {
      return trigger <= 1000;
    }
  } receding;
  EXPECT_EQ(director.tick({.at = now}, kPeriod, receding, {}).trigger, 1000u);
}

TEST_F(DirectorOnAnArcOfFive, DelayCountsBackFromTheNewestMomentAtOnce) {
  const Shot shot = setDelay(seconds(3));
  EXPECT_EQ(shot.mode, Mode::kDelayed);
  EXPECT_EQ(shot.trigger, 1000u - 120u);
  EXPECT_EQ(shot.delay, seconds(3));
  history.newest = 1010;
  EXPECT_EQ(tick().trigger, 1010u - 120u);
}

TEST_F(DirectorOnAnArcOfFive, DelayIsRoundedToWholeTriggers) {
  EXPECT_EQ(setDelay(milliseconds(12)).trigger, 1000u);
  EXPECT_EQ(setDelay(milliseconds(13)).trigger, 999u);
}

TEST_F(DirectorOnAnArcOfFive, DelayEndsAtTheHistorysEndAndSaysSo) {
  const Shot shot = setDelay(seconds(60));
  EXPECT_EQ(shot.trigger, 1000u - kSets + 1 + 4);  // the margin keeps off the recycled end
  EXPECT_TRUE(shot.at_history_end);
  EXPECT_EQ(shot.delay, 295 * kPeriod);
  EXPECT_EQ(setDelay(rt::Nanoseconds::max()).trigger, shot.trigger);
}

TEST_F(DirectorOnAnArcOfFive, DelayZeroOrNegativeIsLive) {
  (void)setDelay(seconds(3));
  EXPECT_EQ(setDelay({}).mode, Mode::kLive);
  (void)setDelay(seconds(3));
  EXPECT_EQ(setDelay(seconds(-3)).mode, Mode::kLive);
}

TEST_F(DirectorOnAnArcOfFive, DelayKeysClimbALadderToTheHistorysEndAndBackToLive) {
  std::vector<rt::Nanoseconds> up;
  for (int i = 0; i < 8; ++i) up.push_back(press(kDelayMore).delay);
  const rt::Nanoseconds longest = 295 * kPeriod;
  EXPECT_EQ(up, (std::vector<rt::Nanoseconds>{milliseconds(500), seconds(1), seconds(2), seconds(3),
                                              seconds(5), seconds(7), longest, longest}));
  std::vector<rt::Nanoseconds> down;
  for (int i = 0; i < 7; ++i) down.push_back(press(kDelayLess).delay);
  EXPECT_EQ(
      down,
      (std::vector<rt::Nanoseconds>{
          seconds(7), seconds(5), seconds(3), seconds(2), seconds(1), milliseconds(500), {}}));
  EXPECT_EQ(press(kDelayLess).mode, Mode::kLive);
}

TEST_F(DirectorOnAnArcOfFive, DelayLessWorksAtOnceWhenTheHistoryIsShorterThanTheDelay) {
  history.newest = 100;  // 2.4 s can be shown
  (void)setDelay(seconds(30));
  EXPECT_EQ(press(kDelayLess).delay, seconds(2));
}

TEST_F(DirectorOnAnArcOfFive, DelayShowsTheOldestMomentUntilTheHistoryHasGrown) {
  history.newest = 50;
  EXPECT_EQ(setDelay(seconds(2)).trigger, 5u);
  history.newest = 80;
  EXPECT_EQ(tick().trigger, 5u);
  history.newest = 90;
  const Shot shot = tick();
  EXPECT_EQ(shot.trigger, 10u);
  EXPECT_FALSE(shot.at_history_end);
}

TEST_F(DirectorOnAnArcOfFive, FreezeKeepsTheShownMomentWhileCaptureGoesOn) {
  (void)tick();
  history.newest = 1003;
  Shot shot = press(kFreezeToggle);
  EXPECT_EQ(shot.mode, Mode::kFrozen);
  EXPECT_EQ(shot.trigger, 1000u);  // what was on the screen, not what came meanwhile
  history.newest = 1170;
  shot = tick();
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_EQ(shot.delay, milliseconds(4250));
}

TEST_F(DirectorOnAnArcOfFive, FreezeAgainGoesOnWithTheDelayFromBefore) {
  (void)setDelay(seconds(2));
  EXPECT_EQ(press(kFreezeToggle).mode, Mode::kFrozen);
  const Shot shot = press(kFreezeToggle);
  EXPECT_EQ(shot.mode, Mode::kDelayed);
  EXPECT_EQ(shot.delay, seconds(2));
}

TEST_F(DirectorOnAnArcOfFive, AFrozenMomentStaysHoweverLongAndAsksForItsFrames) {
  (void)tick();
  EXPECT_EQ(tick().hold, 0u);
  EXPECT_EQ(press(kFreezeToggle).hold, 1000u);
  history.held = 1000;
  history.newest = 1000 + 10 * kSets;
  const Shot shot = tick();
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_EQ(shot.hold, 1000u);
  EXPECT_EQ(shot.mode, Mode::kFrozen);
  EXPECT_FALSE(shot.at_history_end) << "nothing beyond the memory was asked for";
  EXPECT_EQ(press(kViewRight).trigger, 1000u);
}

TEST_F(DirectorOnAnArcOfFive, AFrozenPictureThatNobodyHasAnyMoreStaysOnTheScreen) {
  (void)tick();
  (void)press(kFreezeToggle);
  history.newest = 1000 + 10 * kSets;
  const Shot shot = tick();
  EXPECT_EQ(shot.mode, Mode::kFrozen);
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(press(kViewRight).camera_shown, 2u);
}

TEST_F(DirectorOnAnArcOfFive, AMomentThatCouldNotBeKeptIsLeftForTheOneThatWas) {
  (void)tick();
  (void)press(kFreezeToggle);
  history.held = 1000;
  (void)press(kStepBack);
  const Shot shot = tick();  // 999 was overwritten before it could be kept
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_TRUE(shot.at_history_end);
}

TEST_F(DirectorOnAnArcOfFive, AStepNeverLeavesAHeldMomentForALaterOneOfTheMemory) {
  (void)tick();
  (void)press(kFreezeToggle);
  history.held = 1000;
  history.newest = 2000;
  for (const auto step : {kStepBack, kStepForward}) {
    const Shot shot = press(step);
    EXPECT_EQ(shot.trigger, 1000u);
    EXPECT_TRUE(shot.at_history_end);
    EXPECT_EQ(director.outcomes().front(), CommandOutcome::kAtMemorysEnd);
  }
}

TEST_F(DirectorOnAnArcOfFive, StepFreezesFirstAndThenMovesByOneTrigger) {
  (void)tick();
  Shot shot = press(kStepBack);
  EXPECT_EQ(shot.mode, Mode::kFrozen);
  EXPECT_EQ(shot.trigger, 999u);
  EXPECT_EQ(press(kStepForward).trigger, 1000u);
  EXPECT_EQ(press(kStepForward).trigger, 1000u);  // nothing newer exists
  history.newest = 1001;
  EXPECT_EQ(press(kStepForward).trigger, 1001u);
}

TEST_F(DirectorOnAnArcOfFive, StepBackStopsAtTheHistorysEnd) {
  (void)setDelay(seconds(60));
  const std::uint64_t end = press(kFreezeToggle).trigger;
  const Shot shot = press(kStepBack);
  EXPECT_EQ(shot.trigger, end);
  EXPECT_TRUE(shot.at_history_end);
  EXPECT_FALSE(press(kStepForward).at_history_end);
}

TEST_F(DirectorOnAnArcOfFive, SeveralCommandsOfOneTickAllAct) {
  (void)tick();
  EXPECT_EQ(tick({{.kind = kViewRight}, {.kind = kViewRight}}).camera_shown, 4u);
}

TEST_F(DirectorOnAnArcOfFive, StepPassesOverMomentsThatNobodyHas) {
  (void)tick();
  for (std::uint32_t camera = 0; camera < 5; ++camera) history.holes.insert({camera, 999});
  EXPECT_EQ(press(kStepBack).trigger, 998u);
  EXPECT_EQ(press(kStepForward).trigger, 1000u);
}

TEST_F(DirectorOnAnArcOfFive, DelayedBridgesAFewMissingFramesWithThePreviousOne) {
  history.holes = {{2, 878}, {2, 879}, {2, 880}};
  Shot shot = setDelay(seconds(3));
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(shot.trigger, 877u);
  history.holes.insert({2, 877});
  shot = tick();
  EXPECT_EQ(shot.trigger, 880u);
  EXPECT_EQ(shot.camera_shown, 1u);
  EXPECT_EQ(shot.substitute, Substitute::kNoFrame);
}

TEST_F(DirectorOnAnArcOfFive, GoLiveLeavesEveryModeWithOnePress) {
  (void)setDelay(seconds(3));
  EXPECT_EQ(press(kGoLive).mode, Mode::kLive);
  (void)press(kFreezeToggle);
  EXPECT_EQ(press(kGoLive).mode, Mode::kLive);
  (void)press(kSweep);
  const Shot shot = press(kGoLive);
  EXPECT_EQ(shot.mode, Mode::kLive);
  EXPECT_EQ(shot.trigger, history.newest);
}

TEST_F(DirectorOnAnArcOfFive, DelayKeysLeaveAFrozenMoment) {
  (void)tick();
  (void)press(kFreezeToggle);
  const Shot shot = press(kDelayMore);
  EXPECT_EQ(shot.mode, Mode::kDelayed);
  EXPECT_EQ(shot.delay, milliseconds(500));
}

TEST_F(DirectorOnAnArcOfFive, CommandsThatNameAStateChangeNothingTheSecondTime) {
  (void)tick();
  for (int i = 0; i < 20; ++i) {
    history.newest += 3;
    EXPECT_EQ(tick({{.kind = kFreeze}, {.kind = kFreeze}}).trigger, 1000u);
  }
  EXPECT_EQ(press(kStartSweep).mode, Mode::kSweep);
  (void)tick({}, milliseconds(100));
  EXPECT_EQ(press(kStartSweep).mode, Mode::kSweep);
  EXPECT_EQ(tick({}, milliseconds(40)).camera_wanted, 3u) << "it goes on, it does not start again";
  EXPECT_EQ(press(kFreeze).mode, Mode::kFrozen);
  EXPECT_EQ(press(kThaw).mode, Mode::kLive);
  EXPECT_EQ(press(kThaw).mode, Mode::kLive);
}

TEST_F(DirectorOnAnArcOfFive, EveryCommandHasItsOutcome) {
  history.newest = 0;
  (void)tick({{.kind = kGoLive}, {.kind = kFreeze}, {.kind = kSetView, .camera = 5}});
  EXPECT_THAT(director.outcomes(),
              testing::ElementsAre(CommandOutcome::kApplied, CommandOutcome::kNoPictureYet,
                                   CommandOutcome::kNoSuchView));
  history.newest = 1000;
  (void)tick();
  (void)press(kStepForward);
  EXPECT_THAT(director.outcomes(), testing::ElementsAre(CommandOutcome::kNothingNewer));
  (void)tick();
  EXPECT_THAT(director.outcomes(), testing::IsEmpty());
}

}  // namespace
}  // namespace director_test

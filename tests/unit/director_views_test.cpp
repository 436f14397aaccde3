#include <cstdint>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/director_fixture.h"

namespace director_test {
namespace {

TEST_F(DirectorOnAnArcOfFive, StartsLiveWithTheNewestTriggerOfTheFirstView) {
  const Shot shot = tick();
  EXPECT_EQ(shot.mode, Mode::kLive);
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_EQ(shot.substitute, Substitute::kNone);
}

TEST_F(DirectorOnAnArcOfFive, LiveDoesNotWaitForTheOtherCameras) {
  history.newest_of = {1000, 1000, 1001, 1000, 1000};
  EXPECT_EQ(tick().trigger, 1001u);
}

TEST_F(DirectorOnAnArcOfFive, ViewKeysStopAtTheEndsOfTheArc) {
  (void)tick();
  EXPECT_EQ(press(kViewRight).camera_shown, 3u);
  EXPECT_EQ(press(kViewRight).camera_shown, 4u);
  EXPECT_EQ(press(kViewRight).camera_shown, 4u);
  for (int i = 0; i < 6; ++i) (void)press(kViewLeft);
  EXPECT_EQ(tick().camera_shown, 0u);
}

TEST_F(DirectorOnAnArcOfFive, ViewsOfOtherCamerasShowTheSameFrozenMoment) {
  (void)tick();
  (void)press(kFreezeToggle);
  history.newest = 1005;
  const Shot shot = press(kViewRight);
  EXPECT_EQ(shot.mode, Mode::kFrozen);
  EXPECT_EQ(shot.trigger, 1000u);
}

TEST_F(DirectorOnAnArcOfFive, AViewThatDoesNotExistIsIgnored) {
  EXPECT_EQ(setView(4).camera_shown, 4u);
  EXPECT_EQ(setView(5).camera_shown, 4u);
}

TEST_F(DirectorOnAnArcOfFive, ALostCameraIsReplacedByItsLeftNeighbourAndReturnsByItself) {
  (void)tick();
  history.lost = {2};
  Shot shot = tick();
  EXPECT_EQ(shot.camera_wanted, 2u);
  EXPECT_EQ(shot.camera_shown, 1u);
  EXPECT_EQ(shot.substitute, Substitute::kLost);
  history.lost = {};
  shot = tick();
  EXPECT_EQ(shot.camera_shown, 1u) << "not before it has delivered for a second";
  EXPECT_EQ(shot.substitute, Substitute::kLost);
  shot = tick({}, seconds(1));
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(shot.substitute, Substitute::kNone);
}

TEST_F(DirectorOnAnArcOfFive, ACameraThatComesAndGoesDoesNotMakeTheViewJump) {
  for (const bool delayed : {false, true}) {
    history.holes.clear();
    history.lost.clear();
    (void)(delayed ? setDelay(seconds(1)) : press(kGoLive));
    int jumps = 0;
    std::uint32_t shown = tick().camera_shown;
    for (int i = 0; i < 400; ++i) {
      ++history.newest;
      const bool off = i / 6 % 2 == 1;
      history.lost = off ? std::set<std::uint32_t>{2} : std::set<std::uint32_t>{};
      if (off) history.holes.insert({2, history.newest});
      const std::uint32_t now_shown = tick().camera_shown;
      jumps += now_shown == shown ? 0 : 1;
      shown = now_shown;
    }
    EXPECT_EQ(jumps, 1) << "to the neighbour";
    EXPECT_EQ(shown, 1u);
  }
}

TEST_F(DirectorOnAnArcOfFive, ACameraThatCannotSeeTheTargetIsReplaced) {
  history.blind = {2};
  EXPECT_EQ(tick().camera_shown, 1u);
  EXPECT_EQ(tick().substitute, Substitute::kCannotSee);
  (void)setView(1);
  EXPECT_EQ(press(kViewRight).camera_shown, 3u);
  EXPECT_EQ(tick().substitute, Substitute::kNone);
}

TEST_F(DirectorOnAnArcOfFive, OfTwoEquallyNearNeighboursTheOneShownBeforeStays) {
  history.lost = {1, 2};
  EXPECT_EQ(tick().camera_shown, 3u);
  history.lost = {2};
  EXPECT_EQ(tick().camera_shown, 3u);
}

TEST_F(DirectorOnAnArcOfFive, TheNearestLivingNeighbourIsTaken) {
  history.lost = {1, 2, 3};
  EXPECT_EQ(tick().camera_shown, 0u);
  history.lost = {0, 1, 2, 3};
  EXPECT_EQ(tick().camera_shown, 4u);
}

TEST_F(DirectorOnAnArcOfFive, WithoutAnyLivingCameraTheLastPictureStaysAndIsMarked) {
  history.lost = {0, 1, 2, 3, 4};
  const Shot shot = tick();
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_EQ(shot.substitute, Substitute::kLost);
}

TEST_F(DirectorOnAnArcOfFive, ACameraThatNeverDeliveredIsSubstitutedInLiveMode) {
  history.empty = {2};
  const Shot shot = tick();
  EXPECT_EQ(shot.camera_shown, 1u);
  EXPECT_EQ(shot.substitute, Substitute::kNoFrame);
}

TEST_F(DirectorOnAnArcOfFive, ViewKeysStepOverLostCamerasAndMoveFromTheSubstitute) {
  (void)setView(1);
  history.lost = {2};
  EXPECT_EQ(press(kViewRight).camera_shown, 3u);
  history.lost = {3, 4};
  (void)tick();
  EXPECT_EQ(tick({}, seconds(1)).camera_shown, 2u);  // wanted 3, its left neighbour shown
  EXPECT_EQ(press(kViewLeft).camera_shown, 1u);
}

TEST_F(DirectorOnAnArcOfFive, AMomentStoredBeforeItsCameraWasLostIsStillShown) {
  (void)tick();
  (void)press(kFreezeToggle);
  history.lost = {2};
  history.newest_of[2] = 1000;
  history.newest = 1040;
  const Shot shot = tick();
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(shot.substitute, Substitute::kNone);
}

TEST_F(DirectorOnAnArcOfFive, AFrozenMomentThatTheViewLacksIsShownByTheNeighbour) {
  (void)tick();
  history.holes = {{2, 999}};
  Shot shot = press(kStepBack);
  EXPECT_EQ(shot.trigger, 999u);
  EXPECT_EQ(shot.camera_shown, 1u);
  EXPECT_EQ(shot.substitute, Substitute::kNoFrame);
  shot = press(kStepBack);
  EXPECT_EQ(shot.trigger, 998u);
  EXPECT_EQ(shot.camera_shown, 2u);
}

TEST_F(DirectorOnAnArcOfFive, HomeIsLiveAndTheMiddleViewFromEveryMode) {
  for (const auto kind : {kGoLive, kFreezeToggle, kDelayMore, kStepBack, kSweep}) {
    tick();
    setView(4);
    press(kind);
    const Shot shot = press(kHome);
    EXPECT_EQ(shot.mode, Mode::kLive);
    EXPECT_EQ(shot.camera_shown, 2u);
    EXPECT_EQ(shot.trigger, 1000u);
    EXPECT_EQ(press(kFreezeToggle).mode, Mode::kFrozen) << "nothing of the mode before is left";
    press(kGoLive);
  }
}

TEST_F(DirectorOnAnArcOfFive, AComparisonAddsAnotherViewOfTheSameMoment) {
  const Command compare{
      .kind = kCompare, .camera = 4, .composition = {.layout = appliance::Layout::kSideBySide}};
  (void)tick({compare});
  EXPECT_THAT(director.outcomes(), testing::ElementsAre(CommandOutcome::kApplied));
  Shot shot = tick();
  EXPECT_EQ(shot.composition.layout, appliance::Layout::kSideBySide);
  EXPECT_EQ(shot.second, (appliance::ShownFrame{4, 1000}));
  (void)press(kFreeze);
  history.newest = 1010;
  shot = press(kStepBack);
  EXPECT_EQ(shot.trigger, 999u);
  EXPECT_EQ(shot.second, (appliance::ShownFrame{4, 999}));
  history.holes = {{4, 998}};
  shot = press(kStepBack);
  EXPECT_EQ(shot.composition.layout, appliance::Layout::kSingle);
  EXPECT_EQ(shot.second.trigger, 0u) << "no other moment stands in for it";
  EXPECT_TRUE(shot.second_missing);
}

TEST_F(DirectorOnAnArcOfFive, AnEarlierMomentOfTheSameViewFollowsItAroundTheArcAndIsKept) {
  const Command compare{.kind = kCompare,
                        .camera = Command::kSameView,
                        .delay = seconds(1),
                        .composition = {.layout = appliance::Layout::kSideBySide}};
  (void)tick({compare});
  Shot shot = press(kViewRight);
  EXPECT_EQ(shot.second, (appliance::ShownFrame{3, 960}));
  EXPECT_EQ(shot.hold_second, 0u) << "time runs";
  shot = press(kFreeze);
  EXPECT_EQ(shot.hold, 1000u);
  EXPECT_EQ(shot.hold_second, 960u);
  shot = press(kViewLeft);
  EXPECT_EQ(shot.second, (appliance::ShownFrame{2, 960}));
  EXPECT_EQ(press(kHome).hold_second, 0u);
}

TEST_F(DirectorOnAnArcOfFive, AComparisonThatIsRefusedLeavesTheOneBefore) {
  Command compare{
      .kind = kCompare, .camera = 4, .composition = {.layout = appliance::Layout::kWipe}};
  (void)tick({compare});
  compare.camera = 5;
  const Shot shot = tick({compare});
  EXPECT_THAT(director.outcomes(), testing::ElementsAre(CommandOutcome::kNoSuchView));
  EXPECT_EQ(shot.second, (appliance::ShownFrame{4, 1000}));
}

TEST_F(DirectorOnAnArcOfFive, AComparisonMayBeTheSameViewSomeTimeEarlier) {
  const Command ghost{.kind = kCompare,
                      .camera = 2,
                      .delay = seconds(1),
                      .composition = {.layout = appliance::Layout::kGhost, .share = 0.3F}};
  const Shot shot = tick({ghost});
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_EQ(shot.second, (appliance::ShownFrame{2, 960}));
  EXPECT_EQ(press(kHome).second.trigger, 0u);
  (void)tick({ghost});
  EXPECT_EQ(tick({{.kind = kCompare}}).second.trigger, 0u);
  Command nowhere = ghost;
  nowhere.camera = 5;
  (void)tick({nowhere});
  EXPECT_THAT(director.outcomes(), testing::ElementsAre(CommandOutcome::kNoSuchView));
}

}  // namespace
}  // namespace director_test

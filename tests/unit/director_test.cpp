#include "appliance/director/director.h"

#include <initializer_list>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using appliance::Command;
using appliance::Director;
using appliance::DirectorParameters;
using appliance::Mode;
using appliance::Shot;
using appliance::StoredRange;
using appliance::StoredViews;
using appliance::Substitute;
using enum appliance::Command::Kind;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr rt::Nanoseconds kPeriod = milliseconds(25);
constexpr std::uint32_t kSets = 300;

/// A history of five cameras that store every trigger, unless a test takes something away.
class FakeHistory : public StoredViews {
 public:
  [[nodiscard]] std::uint32_t cameras() const noexcept override { return 5; }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const noexcept override {
    const std::uint64_t last = newest_of[camera] != 0 ? newest_of[camera] : newest;
    if (last == 0 || empty.contains(camera)) return {};
    return {last > kSets ? last - kSets + 1 : 1, last};
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const noexcept override {
    const StoredRange stored = range(camera);
    return !stored.empty() && trigger >= stored.oldest && trigger <= stored.newest &&
           !holes.contains({camera, trigger});
  }
  [[nodiscard]] bool living(std::uint32_t camera) const noexcept override {
    return !lost.contains(camera);
  }

  std::uint64_t newest = 1000;
  std::array<std::uint64_t, 5> newest_of{};  // where it differs
  std::set<std::uint32_t> lost;
  std::set<std::uint32_t> empty;
  std::set<std::pair<std::uint32_t, std::uint64_t>> holes;
};

class DirectorOnAnArcOfFive : public testing::Test {
 protected:
  Shot tick(std::initializer_list<Command> commands = {}, rt::Nanoseconds passed = kPeriod) {
    now += passed;
    return director.tick(now, kPeriod, history, std::vector<Command>(commands));
  }
  Shot press(Command::Kind kind) { return tick({Command{.kind = kind}}); }
  Shot setView(std::uint32_t camera) { return tick({Command{.kind = kSetView, .camera = camera}}); }
  Shot setDelay(rt::Nanoseconds delay) {
    return tick({Command{.kind = kSetDelay, .delay = delay}});
  }

  FakeHistory history;
  Director director{
      DirectorParameters{.first_view = 2,
                         .delay_ladder = {milliseconds(500), seconds(1), seconds(2), seconds(3),
                                          seconds(5), seconds(7), seconds(10)}}};
  rt::Timestamp now = rt::fromNs(1'000'000'000);
};

TEST_F(DirectorOnAnArcOfFive, StartsLiveWithTheNewestTriggerOfTheFirstView) {
  const Shot shot = tick();
  EXPECT_EQ(shot.mode, Mode::kLive);
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(shot.trigger, 1000u);
  EXPECT_EQ(shot.substitute, Substitute::kNone);
}

TEST_F(DirectorOnAnArcOfFive, ShowsNothingBeforeTheFirstFrameAndIgnoresFreezeThen) {
  history.newest = 0;
  EXPECT_EQ(tick().trigger, 0u);
  EXPECT_EQ(press(kFreezeToggle).mode, Mode::kLive);
  EXPECT_EQ(press(kSweep).mode, Mode::kLive);
  EXPECT_EQ(press(kStepBack).mode, Mode::kLive);
  EXPECT_EQ(press(kDelayMore).mode, Mode::kLive);
}

TEST_F(DirectorOnAnArcOfFive, LiveDoesNotWaitForTheOtherCameras) {
  history.newest_of = {1000, 1000, 1001, 1000, 1000};
  EXPECT_EQ(tick().trigger, 1001u);
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
  EXPECT_EQ(director.tick(now, kPeriod, receding, {}).trigger, 1000u);
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

TEST_F(DirectorOnAnArcOfFive, AFrozenMomentWalksAlongTheHistorysEndWhenOvertaken) {
  (void)tick();
  (void)press(kFreezeToggle);
  history.newest = 1295;
  EXPECT_EQ(tick().trigger, 1000u);
  EXPECT_FALSE(tick().at_history_end);
  history.newest = 1300;
  const Shot shot = tick();
  EXPECT_EQ(shot.trigger, 1005u);
  EXPECT_TRUE(shot.at_history_end);
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
  EXPECT_EQ(press(kStepBack).trigger, end);
}

TEST_F(DirectorOnAnArcOfFive, ViewKeysStopAtTheEndsOfTheArc) {
  (void)tick();
  EXPECT_EQ(press(kViewRight).camera_shown, 3u);
  EXPECT_EQ(press(kViewRight).camera_shown, 4u);
  EXPECT_EQ(press(kViewRight).camera_shown, 4u);
  for (int i = 0; i < 6; ++i) (void)press(kViewLeft);
  EXPECT_EQ(tick().camera_shown, 0u);
}

TEST_F(DirectorOnAnArcOfFive, SeveralCommandsOfOneTickAllAct) {
  (void)tick();
  EXPECT_EQ(tick({{.kind = kViewRight}, {.kind = kViewRight}}).camera_shown, 4u);
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
  EXPECT_EQ(shot.camera_shown, 2u);
  EXPECT_EQ(shot.substitute, Substitute::kNone);
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
  history.lost = {3};
  EXPECT_EQ(tick().camera_shown, 2u);  // wanted 3, its left neighbour shown
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

TEST_F(DirectorOnAnArcOfFive, AFrozenMomentThatNobodyHasIsReplacedByTheNearestOne) {
  (void)tick();
  for (std::uint32_t camera = 0; camera < 5; ++camera) history.holes.insert({camera, 999});
  EXPECT_EQ(press(kStepBack).trigger, 998u);
  EXPECT_EQ(press(kStepBack).trigger, 998u);
  EXPECT_EQ(press(kStepBack).trigger, 997u);
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

TEST_F(DirectorOnAnArcOfFive, DelayKeysLeaveAFrozenMoment) {
  (void)tick();
  (void)press(kFreezeToggle);
  const Shot shot = press(kDelayMore);
  EXPECT_EQ(shot.mode, Mode::kDelayed);
  EXPECT_EQ(shot.delay, milliseconds(500));
}

TEST_F(DirectorOnAnArcOfFive, SweepVisitsEveryViewOfOneMomentAndReturns) {
  (void)tick();
  std::vector<std::uint32_t> walk = {press(kSweep).camera_shown};
  for (int i = 0; i < 8; ++i) {
    history.newest += 2;
    const Shot shot = tick({}, milliseconds(50));  // 20 views a second
    EXPECT_EQ(shot.trigger, 1000u);
    walk.push_back(shot.camera_shown);
    EXPECT_EQ(shot.mode, i < 7 ? Mode::kSweep : Mode::kFrozen);
  }
  EXPECT_EQ(walk, (std::vector<std::uint32_t>{2, 3, 4, 3, 2, 1, 0, 1, 2}));
}

TEST_F(DirectorOnAnArcOfFive, SweepKeepsItsDurationWhenTicksComeLate) {
  (void)tick();
  (void)press(kSweep);
  EXPECT_EQ(tick({}, milliseconds(250)).camera_shown, 1u);
  EXPECT_EQ(tick({}, milliseconds(150)).mode, Mode::kFrozen);
}

TEST_F(DirectorOnAnArcOfFive, FreezeOrSweepStopASweepAtTheViewItHasReached) {
  for (const auto stop : {kFreezeToggle, kSweep}) {
    (void)setView(2);
    (void)press(kSweep);
    (void)tick({}, milliseconds(100));
    const Shot shot = press(stop);
    EXPECT_EQ(shot.mode, Mode::kFrozen);
    EXPECT_EQ(shot.camera_shown, 4u);
    (void)press(kGoLive);
  }
}

TEST_F(DirectorOnAnArcOfFive, ViewAndStepKeysGoOnFromWhereTheyStopASweep) {
  (void)tick();
  (void)press(kSweep);
  (void)tick({}, milliseconds(100));
  EXPECT_EQ(press(kViewLeft).camera_shown, 3u);
  (void)press(kSweep);
  (void)tick({}, milliseconds(50));
  const Shot shot = press(kStepBack);
  EXPECT_EQ(shot.camera_shown, 4u);
  EXPECT_EQ(shot.trigger, 999u);
}

TEST_F(DirectorOnAnArcOfFive, LeavingTheMomentDuringASweepReturnsToItsFirstView) {
  for (const auto leave : {kGoLive, kDelayMore}) {
    (void)setView(2);
    (void)press(kSweep);
    (void)tick({}, milliseconds(100));
    EXPECT_EQ(press(leave).camera_shown, 2u);
    (void)press(kGoLive);
  }
}

TEST_F(DirectorOnAnArcOfFive, SweepShowsTheNeighbourWhereAViewLacksTheMoment) {
  (void)tick();
  history.holes = {{3, 1000}};
  (void)press(kSweep);
  const Shot shot = tick({}, milliseconds(50));
  EXPECT_EQ(shot.camera_wanted, 3u);
  EXPECT_EQ(shot.camera_shown, 2u);
}

}  // namespace

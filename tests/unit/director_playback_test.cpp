#include <chrono>
#include <initializer_list>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/director/director.h"

namespace {

using appliance::Command;
using appliance::CommandOutcome;
using appliance::Director;
using appliance::DirectorParameters;
using appliance::Mode;
using appliance::Rate;
using appliance::Shot;
using appliance::StoredRange;
using appliance::StoredViews;
using enum appliance::Command::Kind;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr rt::Nanoseconds kPeriod = milliseconds(25);
constexpr std::uint64_t kSets = 300;

/// Three cameras that store every trigger.
class FullHistory : public StoredViews {
 public:
  [[nodiscard]] std::uint32_t cameras() const noexcept override { return 3; }
  [[nodiscard]] StoredRange range(std::uint32_t) const noexcept override {
    return {newest > kSets ? newest - kSets + 1 : 1, newest};
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const noexcept override {
    const StoredRange stored = range(camera);
    return trigger == held || (trigger >= stored.oldest && trigger <= stored.newest);
  }
  [[nodiscard]] bool living(std::uint32_t) const noexcept override { return true; }
  [[nodiscard]] std::uint64_t heldTrigger() const noexcept override { return held; }

  std::uint64_t newest = 1000;
  std::uint64_t held = 0;
};

/// A box at 40 triggers a second and a screen of 80 Hz: two vblanks per trigger.
class DirectorAtAScreen : public testing::Test {
 protected:
  /// The next vblank; every second one a trigger's frames have come.
  Shot vblank(std::initializer_list<Command> commands = {}) {
    now += kPeriod / 2;
    if (++vblanks % 2 == 0) ++history.newest;
    const Shot shot = director.tick({.at = now, .refresh = kPeriod / 2}, kPeriod, history,
                                    std::vector<Command>(commands));
    history.held = shot.hold;
    return shot;
  }
  Shot press(Command::Kind kind) { return vblank({Command{.kind = kind}}); }
  /// How many vblanks each of the next triggers is shown, the first and the last left out.
  std::vector<int> durations(int of_vblanks) {
    std::vector<int> shown;
    std::uint64_t last = 0;
    for (int i = 0; i < of_vblanks; ++i) {
      const std::uint64_t trigger = vblank().trigger;
      if (trigger != last) {
        if (last != 0) {
          EXPECT_EQ(trigger, last + 1);
        }
        shown.push_back(0);
      }
      ++shown.back();
      last = trigger;
    }
    shown.erase(shown.begin());
    shown.pop_back();
    return shown;
  }

  FullHistory history;
  Director director{
      DirectorParameters{.first_view = 1, .delay_ladder = {milliseconds(500), seconds(2)}}};
  rt::Timestamp now = rt::fromNs(1'000'000'000);
  int vblanks = 0;
};

TEST_F(DirectorAtAScreen, SpeedGoesThroughTheRatesAndBackToFullSpeed) {
  (void)vblank();
  std::vector<std::pair<Mode, Rate>> pressed;
  for (int i = 0; i < 4; ++i) {
    const Shot shot = press(kSlower);
    pressed.emplace_back(shot.mode, shot.rate);
    for (int j = 0; j < 8; ++j) (void)vblank();
  }
  EXPECT_EQ(pressed, (std::vector<std::pair<Mode, Rate>>{{Mode::kSlow, Rate::kHalf},
                                                         {Mode::kSlow, Rate::kQuarter},
                                                         {Mode::kSlow, Rate::kEighth},
                                                         {Mode::kDelayed, Rate::kFull}}));
}

TEST_F(DirectorAtAScreen, SlowMotionShowsEveryTriggerForTheSameNumberOfVblanks) {
  (void)vblank();
  for (const auto& [rate, each] :
       {std::pair{Rate::kHalf, 4}, std::pair{Rate::kQuarter, 8}, std::pair{Rate::kEighth, 16}}) {
    (void)vblank({{.kind = kSetRate, .rate = rate}});
    for (const int shown : durations(10 * each)) EXPECT_EQ(shown, each);
  }
}

TEST_F(DirectorAtAScreen, DelayedShowsEveryTriggerForTwoVblanks) {
  (void)vblank();
  (void)vblank({{.kind = kSetDelay, .delay = seconds(2)}});
  for (const int shown : durations(200)) EXPECT_EQ(shown, 2);
}

TEST_F(DirectorAtAScreen, DelayedStaysEvenWhenFramesComeUnevenly) {
  (void)vblank();
  (void)vblank({{.kind = kSetDelay, .delay = seconds(2)}});
  std::uint64_t last = vblank().trigger;
  int same = 1;
  for (int i = 0; i < 200; ++i) {
    const std::uint64_t newest = history.newest;
    if (i % 5 == 0) --history.newest;  // a frame that comes a vblank late
    const std::uint64_t trigger = vblank().trigger;
    if (i % 5 == 0) history.newest = newest + (vblanks % 2 == 0 ? 1 : 0);
    if (trigger == last) {
      ++same;
      continue;
    }
    EXPECT_EQ(trigger, last + 1);
    if (i > 2) {
      EXPECT_EQ(same, 2) << i;
    }
    last = trigger;
    same = 1;
  }
}

TEST_F(DirectorAtAScreen, SlowMotionFromAFrozenMomentBeginsThereAndThawsToTheSameRate) {
  for (int i = 0; i < 40; ++i) (void)vblank();
  const std::uint64_t frozen = press(kFreezeToggle).trigger;
  const std::uint64_t stepped = press(kStepBack).trigger;
  EXPECT_EQ(stepped, frozen - 1);
  EXPECT_EQ(press(kSlower).trigger, stepped);
  for (int i = 0; i < 4; ++i) (void)vblank();
  const Shot again = press(kFreezeToggle);
  EXPECT_EQ(again.mode, Mode::kFrozen);
  const Shot on = press(kFreezeToggle);
  EXPECT_EQ(on.mode, Mode::kSlow);
  EXPECT_EQ(on.rate, Rate::kHalf);
  EXPECT_EQ(on.trigger, again.trigger);
}

TEST_F(DirectorAtAScreen, FullSpeedAfterSlowMotionKeepsTheDelayThatCameAbout) {
  (void)vblank();
  (void)press(kSlower);
  for (int i = 0; i < 160; ++i) (void)vblank();  // two seconds, of which one was shown
  const Shot shot = vblank({{.kind = kSetRate, .rate = Rate::kFull}});
  EXPECT_EQ(shot.mode, Mode::kDelayed);
  EXPECT_NEAR(static_cast<double>(shot.delay.count()) * 1e-9, 1.0, 0.05);
  EXPECT_EQ(press(kGoLive).mode, Mode::kLive);
}

TEST_F(DirectorAtAScreen, SlowMotionThatTheMemorysEndOvertakesStopsThereAndSaysSo) {
  (void)vblank();
  (void)vblank({{.kind = kSetRate, .rate = Rate::kEighth}});
  Shot shot;
  for (int i = 0; i < 800 && shot.mode != Mode::kFrozen; ++i) {
    shot = vblank();
    ASSERT_TRUE(history.holds(1, shot.trigger));
  }
  EXPECT_EQ(shot.mode, Mode::kFrozen);
  EXPECT_TRUE(shot.at_history_end);
  const std::uint64_t stopped = shot.trigger;
  for (int i = 0; i < 800; ++i) EXPECT_EQ(vblank().trigger, stopped);
  EXPECT_EQ(press(kSlower).trigger, stopped);
  EXPECT_EQ(director.outcomes().front(), CommandOutcome::kAtMemorysEnd);
  EXPECT_EQ(press(kFreezeToggle).mode, Mode::kLive);
}

TEST_F(DirectorAtAScreen, AReplayShowsTheLastSecondsAtItsRateAndGoesOnAsBefore) {
  for (int i = 0; i < 40; ++i) (void)vblank();
  Shot shot = vblank({{.kind = kReplay, .delay = seconds(1), .rate = Rate::kHalf}});
  EXPECT_EQ(shot.mode, Mode::kSlow);
  const std::uint64_t first = shot.trigger;
  EXPECT_EQ(first, history.newest - 40);
  int vblanks_shown = 0;
  std::uint64_t last = 0;
  while (shot.mode == Mode::kSlow && vblanks_shown < 500) {
    last = shot.trigger;
    ++vblanks_shown;
    shot = vblank();
  }
  EXPECT_EQ(vblanks_shown, 160) << "one second at half speed";
  EXPECT_EQ(last, first + 39);
  EXPECT_EQ(shot.mode, Mode::kLive);
  EXPECT_EQ(shot.trigger, history.newest);
}

TEST_F(DirectorAtAScreen, AReplayGoesOnWhileTheViewChangesAndEndsWithOtherCommands) {
  for (int i = 0; i < 40; ++i) (void)vblank();
  const Command replay{.kind = kReplay, .delay = seconds(1), .rate = Rate::kQuarter};
  (void)vblank({replay});
  Shot shot = press(kViewRight);
  EXPECT_EQ(shot.mode, Mode::kSlow);
  EXPECT_EQ(shot.camera_shown, 2u);
  shot = press(kFreeze);
  EXPECT_EQ(shot.mode, Mode::kFrozen);
  EXPECT_EQ(press(kGoLive).mode, Mode::kLive);
}

TEST_F(DirectorAtAScreen, MovesAsksForAPictureAtEveryVblank) {
  (void)vblank();
  EXPECT_FALSE(director.moving());
  for (const auto kind : {kSlower, kDelayMore, kSweep}) {
    (void)press(kind);
    EXPECT_TRUE(director.moving());
  }
  (void)press(kFreeze);
  EXPECT_FALSE(director.moving());
}

TEST(DirectorLeftAlone, GoesHomeAfterTheIdleTimeAndNotBefore) {
  FullHistory history;
  Director director{DirectorParameters{.delay_ladder = {seconds(1)}, .idle_home = seconds(60)}};
  rt::Timestamp now = rt::fromNs(1);
  const auto after = [&](rt::Nanoseconds passed, std::vector<Command> commands = {}) {
    now += passed;
    history.newest += 40;
    const Shot shot = director.tick({.at = now}, kPeriod, history, commands);
    history.held = shot.hold;
    return shot;
  };
  (void)after({});
  for (const auto kind : {kFreeze, kDelayMore, kSlower, kSetView}) {
    (void)after(seconds(1), {{.kind = kind}});
    (void)after(seconds(30), {{.kind = kViewLeft}});
    Shot shot = after(seconds(59));
    EXPECT_FALSE(shot.mode == Mode::kLive && shot.camera_wanted == 1);
    shot = after(seconds(1));
    EXPECT_EQ(shot.mode, Mode::kLive);
    EXPECT_EQ(shot.camera_wanted, 1u);
    EXPECT_EQ(shot.trigger, history.newest);
  }
}

}  // namespace

#include "appliance/panel/panel_controller.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/panel/lamps.h"

namespace {

using appliance::Command;
using appliance::PanelCommand;
using appliance::PanelController;
using hal::Button;
using std::chrono::milliseconds;

class PanelUnderAFakeClock : public testing::Test {
 protected:
  /// What follows from a contact that changes @p at_ms after the start.
  std::optional<PanelCommand> press(Button button, int at_ms) {
    held.insert(button);
    return controller.onEvent({button, true, instant(at_ms)});
  }
  std::optional<PanelCommand> release(Button button, int at_ms) {
    held.erase(button);
    return controller.onEvent({button, false, instant(at_ms)});
  }
  /// When commands repeat until @p until_ms, as a thread that follows nextTime() gets them.
  std::vector<int> repetitions(int until_ms) {
    std::vector<int> causes;
    while (controller.nextTime() && *controller.nextTime() <= instant(until_ms)) {
      if (const auto command = controller.onTime(*controller.nextTime()))
        causes.push_back(static_cast<int>((command->cause - instant(0)) / milliseconds(1)));
    }
    return causes;
  }
  static rt::Timestamp instant(int ms) { return rt::fromNs(5'000'000'000) + milliseconds(ms); }

  std::set<Button> held;
  PanelController controller{[this](Button button) { return held.contains(button); }};
};

TEST_F(PanelUnderAFakeClock, APressActsAtOnceAndItsReleaseDoesNothing) {
  const auto command = press(Button::kFreeze, 10);
  ASSERT_TRUE(command.has_value());
  EXPECT_EQ(command->command.kind, Command::Kind::kFreezeToggle);
  EXPECT_EQ(command->cause, instant(10));
  EXPECT_FALSE(release(Button::kFreeze, 60).has_value());
}

TEST_F(PanelUnderAFakeClock, EveryKeyHasItsCommand) {
  using enum Command::Kind;
  const std::array expected = {kGoLive,      kFreezeToggle, kDelayLess, kDelayMore, kStepBack,
                               kStepForward, kViewLeft,     kViewRight, kSweep,     kSlower};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto button = static_cast<Button>(i);
    const auto command = press(button, 0);
    ASSERT_TRUE(command.has_value()) << hal::kButtons[i].name;
    EXPECT_EQ(command->command.kind, expected[i]) << hal::kButtons[i].name;
    (void)release(button, 1);
  }
}

TEST_F(PanelUnderAFakeClock, AHeldStepKeyRepeatsEightTimesASecondAfter400Ms) {
  (void)press(Button::kStepBack, 0);
  EXPECT_EQ(repetitions(1000), (std::vector<int>{400, 525, 650, 775, 900}));
  (void)release(Button::kStepBack, 1000);
  EXPECT_TRUE(repetitions(5000).empty());
}

TEST_F(PanelUnderAFakeClock, FreezeAndSweepDoNotRepeat) {
  for (const Button button : {Button::kFreeze, Button::kSweep}) {
    (void)press(button, 0);
    EXPECT_TRUE(repetitions(3000).empty());
    (void)release(button, 3000);
  }
}

TEST_F(PanelUnderAFakeClock, LiveActsAtOnceAndHeldFor1500MsGoesHomeOnce) {
  const auto at_once = press(Button::kLive, 0);
  ASSERT_TRUE(at_once.has_value());
  EXPECT_EQ(at_once->command.kind, Command::Kind::kGoLive);
  std::vector<PanelCommand> later;
  while (*controller.nextTime() <= instant(10'000)) {
    if (const auto command = controller.onTime(*controller.nextTime())) later.push_back(*command);
  }
  ASSERT_EQ(later.size(), 1U);
  EXPECT_EQ(later[0].command.kind, Command::Kind::kHome);
  EXPECT_EQ(later[0].cause, instant(1500));
  EXPECT_FALSE(release(Button::kLive, 10'000).has_value());
}

TEST_F(PanelUnderAFakeClock, LiveLetGoInTimeDoesNotGoHome) {
  (void)press(Button::kLive, 0);
  EXPECT_TRUE(repetitions(1490).empty());
  (void)release(Button::kLive, 1490);
  EXPECT_TRUE(repetitions(5000).empty());
  (void)press(Button::kLive, 6000);
  held.erase(Button::kLive);  // this release gets lost
  EXPECT_TRUE(repetitions(20'000).empty());
}

TEST_F(PanelUnderAFakeClock, AnotherKeyPressedMeanwhileKeepsFromGoingHome) {
  (void)press(Button::kLive, 0);
  (void)press(Button::kFreeze, 700);
  EXPECT_TRUE(repetitions(5000).empty());
}

TEST(Lamps, ShowTheModeByOneLamp) {
  using appliance::Mode;
  EXPECT_EQ(appliance::lampOf(Mode::kLive), hal::Lamp::kLive);
  EXPECT_EQ(appliance::lampOf(Mode::kDelayed), hal::Lamp::kDelayed);
  EXPECT_EQ(appliance::lampOf(Mode::kFrozen), hal::Lamp::kFrozen);
  EXPECT_EQ(appliance::lampOf(Mode::kSweep), hal::Lamp::kFrozen);
  EXPECT_EQ(appliance::lampOf(Mode::kSlow), hal::Lamp::kDelayed);
}

TEST_F(PanelUnderAFakeClock, LateCallsDoNotMakeUpForMissedRepetitions) {
  (void)press(Button::kViewLeft, 0);
  EXPECT_TRUE(controller.onTime(instant(2000)).has_value());
  EXPECT_FALSE(controller.onTime(instant(2000)).has_value());
  EXPECT_EQ(repetitions(2200), (std::vector<int>{2125}));
}

TEST_F(PanelUnderAFakeClock, BounceOfThePressedContactIsIgnored) {
  EXPECT_TRUE(press(Button::kStepBack, 0).has_value());
  EXPECT_FALSE(press(Button::kStepBack, 3).has_value());
  EXPECT_FALSE(press(Button::kStepBack, 5).has_value());
  EXPECT_FALSE(release(Button::kLive, 6).has_value());  // it never was down
}

TEST_F(PanelUnderAFakeClock, ALostReleaseStopsTheRepetition) {
  (void)press(Button::kStepBack, 0);
  held.erase(Button::kStepBack);  // the contact opened, the event was lost
  EXPECT_TRUE(repetitions(3000).empty());
  EXPECT_EQ(controller.nextTime(), std::nullopt);
}

TEST_F(PanelUnderAFakeClock, AKeyWorksAgainAfterALostRelease) {
  (void)press(Button::kFreeze, 0);
  held.erase(Button::kFreeze);
  (void)repetitions(300);
  EXPECT_TRUE(press(Button::kFreeze, 400).has_value());
}

TEST_F(PanelUnderAFakeClock, KeysHeldTogetherActAloneAndOnlyTheLastRepeats) {
  (void)press(Button::kViewLeft, 0);
  EXPECT_TRUE(press(Button::kStepBack, 300).has_value());
  std::vector<Command::Kind> kinds;
  while (*controller.nextTime() <= instant(900)) {
    if (const auto command = controller.onTime(*controller.nextTime()))
      kinds.push_back(command->command.kind);
  }
  EXPECT_EQ(kinds, std::vector<Command::Kind>(2, Command::Kind::kStepBack));
}

TEST_F(PanelUnderAFakeClock, AStuckKeyBlocksNoOther) {
  (void)press(Button::kSweep, 0);
  (void)repetitions(60'000);
  const auto command = press(Button::kLive, 60'000);
  ASSERT_TRUE(command.has_value());
  EXPECT_EQ(command->command.kind, Command::Kind::kGoLive);
}

TEST_F(PanelUnderAFakeClock, NothingIsDueWhileNoKeyIsDown) {
  EXPECT_EQ(controller.nextTime(), std::nullopt);
  EXPECT_FALSE(controller.onTime(instant(1000)).has_value());
  (void)press(Button::kStepBack, 0);
  (void)release(Button::kStepBack, 10);
  EXPECT_EQ(controller.nextTime(), std::nullopt);
}

}  // namespace

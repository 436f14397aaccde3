#include <gtest/gtest.h>

#include "ui-kms/kms/screen_machine.h"

namespace {

using namespace std::chrono_literals;
using ui::kms::ScreenMachine;
using ui::kms::Sight;
using State = ScreenMachine::State;
using Task = ScreenMachine::Task;

constexpr Sight kScreen{.usable = true, .unchanged = true, .link_good = true};
constexpr Sight kOther{.usable = true, .unchanged = false, .link_good = true};
constexpr Sight kBadLink{.usable = true, .unchanged = true, .link_good = false};
constexpr Sight kNothing{};

class Screen : public testing::Test {
 protected:
  void light() {
    ASSERT_EQ(machine_.next(now_), Task::kTakeMaster);
    machine_.onMaster(true, now_);
    ASSERT_EQ(machine_.next(now_), Task::kLook);
    machine_.onLook(kScreen, now_);
    ASSERT_EQ(machine_.state(), State::kLighting);
    machine_.onCommitted(now_);
    machine_.onFlip();
    ASSERT_EQ(machine_.state(), State::kShowing);
    ASSERT_EQ(machine_.next(now_), Task::kNone);
  }

  rt::Timestamp now_ = rt::fromNs(1'000'000'000);
  ScreenMachine machine_{now_};
};

TEST_F(Screen, IsTakenLookedAtAndLit) {
  EXPECT_FALSE(machine_.takesPictures());
  light();
  EXPECT_TRUE(machine_.takesPictures());
  EXPECT_EQ(machine_.changes(), 1U);
}

TEST_F(Screen, ThatIsMissingIsLookedForEverySecondAndAtOnceWhenTheKernelSaysSo) {
  machine_.onMaster(true, now_);
  machine_.onLook(kNothing, now_);
  EXPECT_EQ(machine_.state(), State::kSearching);
  EXPECT_EQ(machine_.next(now_ + 999ms), Task::kNone);
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kLook);
  machine_.onLook(kNothing, now_ + 1s);
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kNone);
  machine_.onHotplug();
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kLook);
  machine_.onLook(kScreen, now_ + 1s);
  EXPECT_TRUE(machine_.takesPictures());
}

TEST_F(Screen, ThatIsLitIsOnlyGlancedAt) {
  light();
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kGlance);
  machine_.onGlance(true, now_ + 1s);
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kNone);
  EXPECT_EQ(machine_.next(now_ + 2s), Task::kGlance);
  machine_.onGlance(false, now_ + 2s);
  EXPECT_EQ(machine_.next(now_ + 2s), Task::kLook) << "something is wrong: look closely";
  EXPECT_EQ(machine_.state(), State::kShowing);
}

TEST_F(Screen, ThatIsUnpluggedLosesWhatWasCommittedAndComesBackAsAChange) {
  light();
  machine_.onHotplug();
  machine_.onLook(kNothing, now_);
  EXPECT_FALSE(machine_.takesPictures());
  EXPECT_EQ(machine_.losses(), 1U);
  machine_.onHotplug();
  machine_.onLook(kScreen, now_);
  EXPECT_EQ(machine_.state(), State::kLighting);
  EXPECT_EQ(machine_.changes(), 2U);
  EXPECT_EQ(machine_.losses(), 1U);
}

TEST_F(Screen, AnEventAboutAnotherConnectorChangesNothing) {
  light();
  machine_.onHotplug();
  EXPECT_EQ(machine_.next(now_), Task::kLook);
  machine_.onLook(kScreen, now_);
  EXPECT_EQ(machine_.state(), State::kShowing);
  EXPECT_EQ(machine_.changes(), 1U);
}

TEST_F(Screen, WithAnotherModeOrABadLinkIsLitAgainWithoutLosingItsPictures) {
  for (const Sight& sight : {kOther, kBadLink}) {
    ScreenMachine machine(now_);
    machine.onMaster(true, now_);
    machine.onLook(kScreen, now_);
    machine.onCommitted(now_);
    machine.onLook(sight, now_);
    EXPECT_EQ(machine.state(), State::kLighting);
    EXPECT_EQ(machine.changes(), 2U);
    EXPECT_EQ(machine.losses(), 0U);
    machine.onCommitted(now_);
    EXPECT_EQ(machine.state(), State::kShowing);
  }
}

TEST_F(Screen, ThatTheDriverRefusesIsTriedMoreAndMoreRarely) {
  machine_.onMaster(true, now_);
  for (const auto wait : {1s, 2s, 4s, 8s, 8s, 8s}) {
    machine_.onLook(kScreen, now_);
    machine_.onRefused(now_);
    EXPECT_EQ(machine_.state(), State::kSearching);
    EXPECT_EQ(machine_.next(now_ + wait - 1ms), Task::kNone);
    EXPECT_EQ(machine_.next(now_ + wait), Task::kLook);
  }
  machine_.onHotplug();  // another screen deserves another try
  machine_.onLook(kScreen, now_);
  machine_.onRefused(now_);
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kLook);
}

TEST_F(Screen, WhoseFlipDoesNotComeIsLitAnew) {
  light();
  machine_.onCommitted(now_);
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kGlance);
  machine_.onGlance(true, now_ + 1s);
  EXPECT_EQ(machine_.next(now_ + 1s + 1ms), Task::kLook);
  EXPECT_FALSE(machine_.takesPictures());
  EXPECT_EQ(machine_.losses(), 1U);
  machine_.onLook(kScreen, now_ + 1s);
  EXPECT_EQ(machine_.state(), State::kLighting);
}

TEST_F(Screen, AFlipThatCameInTimeIsNotWaitedFor) {
  light();
  machine_.onCommitted(now_);
  machine_.onFlip();
  EXPECT_EQ(machine_.next(now_ + 10s), Task::kGlance);
  EXPECT_EQ(machine_.state(), State::kShowing);
}

TEST_F(Screen, IsReleasedOnRequestAndTakenOnlyOnRequest) {
  light();
  machine_.release();
  EXPECT_FALSE(machine_.master());
  EXPECT_EQ(machine_.losses(), 1U);
  machine_.onHotplug();
  EXPECT_EQ(machine_.next(now_ + 100s), Task::kNone);
  machine_.take(now_ + 100s);
  EXPECT_EQ(machine_.next(now_ + 100s), Task::kTakeMaster);
  machine_.onMaster(true, now_ + 100s);
  EXPECT_EQ(machine_.next(now_ + 100s), Task::kLook);
  machine_.onLook(kScreen, now_ + 100s);
  EXPECT_EQ(machine_.state(), State::kLighting) << "the other program's mode is not ours";
}

TEST_F(Screen, ThatAnotherProgramHoldsIsAskedForEverySecond) {
  machine_.onMaster(false, now_);
  EXPECT_EQ(machine_.next(now_), Task::kNone);
  machine_.onHotplug();
  EXPECT_EQ(machine_.next(now_), Task::kNone) << "not ours to look after";
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kTakeMaster);
  machine_.onMaster(true, now_ + 1s);
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kLook);
}

TEST_F(Screen, ThatIsTakenAwayIsTakenBack) {
  light();
  machine_.onMasterLost(now_);
  EXPECT_FALSE(machine_.takesPictures());
  EXPECT_EQ(machine_.next(now_), Task::kNone);
  EXPECT_EQ(machine_.next(now_ + 1s), Task::kTakeMaster);
}

TEST_F(Screen, OfACardThatIsGoneStaysGone) {
  light();
  machine_.onDeviceGone();
  machine_.release();
  machine_.take(now_);
  machine_.onHotplug();
  EXPECT_EQ(machine_.state(), State::kLost);
  EXPECT_EQ(machine_.next(now_ + 100s), Task::kNone);
}

TEST_F(Screen, TakingWhatIsOursAlreadyChangesNothing) {
  light();
  machine_.take(now_);
  EXPECT_EQ(machine_.state(), State::kShowing);
  EXPECT_EQ(machine_.next(now_), Task::kNone);
}

}  // namespace

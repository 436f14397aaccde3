#include <gtest/gtest.h>

#include "appliance/capture/camera_machine.h"
#include "appliance/capture/liveness.h"

namespace {

using appliance::CameraAction;
using appliance::CameraFacts;
using appliance::CameraMachine;
using appliance::CameraState;
using appliance::CameraTrouble;
using appliance::kLostAfterTriggers;
using appliance::kTriggersOnTheWire;
using hal::CameraAnswer;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto kPeriod = milliseconds(25);

/// One camera's machine on an invented clock, with a rig that fires every 25 ms.
class CameraLife : public testing::Test {
 protected:
  CameraAction step() { return machine_.step(now_, facts_); }
  CameraState state() const { return machine_.health().state; }
  CameraTrouble trouble() const { return machine_.health().trouble; }

  void answer(CameraAnswer answer, const std::string& controller = "") {
    machine_.probed(now_, {.answer = answer, .controller = controller});
  }
  /// The next trigger; @p frame: whether a frame follows.
  void fire(bool frame) {
    now_ += kPeriod;
    ++facts_.fired;
    if (frame) facts_.stored = facts_.fired;
    came_.push_back(frame);
    facts_.judged = 0;
    facts_.brought = 0;
    for (std::size_t back = kTriggersOnTheWire; back < came_.size() && facts_.judged < 40; ++back) {
      if (came_[came_.size() - 1 - back]) facts_.brought |= std::uint64_t{1} << facts_.judged;
      ++facts_.judged;
    }
  }
  /// Triggers without an action: the first action ends it.
  CameraAction fireUntilAction(std::uint32_t triggers, bool frames) {
    for (std::uint32_t i = 0; i < triggers; ++i) {
      fire(frames);
      const CameraAction action = step();
      if (action != CameraAction::kNone) return action;
    }
    return CameraAction::kNone;
  }
  void openAndStart() {
    ASSERT_EQ(step(), CameraAction::kOpen);
    machine_.opened(now_, "");
    ASSERT_EQ(step(), CameraAction::kStart);
    machine_.started(now_, "", facts_);
  }
  void connect() {
    ASSERT_EQ(step(), CameraAction::kProbe);
    answer(CameraAnswer::kFree);
    openAndStart();
  }
  void stream() {
    connect();
    ASSERT_EQ(fireUntilAction(40, true), CameraAction::kNone);
    ASSERT_EQ(state(), CameraState::kStreaming);
  }
  /// Until the silence is noticed and the camera asked.
  void loseIt() {
    stream();
    ASSERT_EQ(fireUntilAction(40, false), CameraAction::kProbe);
    ASSERT_EQ(state(), CameraState::kLost);
  }
  void close() { machine_.closed(now_); }

  CameraMachine machine_;
  CameraFacts facts_;
  rt::Timestamp now_ = rt::fromNs(1'000'000'000);
  std::vector<bool> came_;
};

TEST_F(CameraLife, BeginsWithAProbeAndOpensWhatIsFree) {
  EXPECT_EQ(state(), CameraState::kConnecting);
  EXPECT_FALSE(machine_.settled());
  connect();
  EXPECT_TRUE(machine_.settled());
  EXPECT_EQ(state(), CameraState::kConnecting) << "nothing is proven yet";
}

TEST_F(CameraLife, GivesNoSecondActionBeforeTheFirstOnesOutcome) {
  ASSERT_EQ(step(), CameraAction::kProbe);
  now_ += seconds(10);
  EXPECT_EQ(step(), CameraAction::kNone);
}

TEST_F(CameraLife, StreamsOnceEveryTriggerOfTheProofBroughtItsFrame) {
  connect();
  EXPECT_EQ(fireUntilAction(CameraMachine::kProofTriggers, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kConnecting) << "too few triggers for a proof";
  EXPECT_EQ(fireUntilAction(4, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
  EXPECT_EQ(trouble(), CameraTrouble::kNone);
}

TEST_F(CameraLife, WithoutTriggersNothingIsLost) {
  stream();
  now_ += seconds(60);
  EXPECT_EQ(step(), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
}

TEST_F(CameraLife, IsLostAfterThreeTriggersBesideThoseOnTheWire) {
  stream();
  constexpr auto kSilent = static_cast<std::uint32_t>(kLostAfterTriggers + kTriggersOnTheWire);
  EXPECT_EQ(fireUntilAction(kSilent - 1, false), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
  EXPECT_EQ(fireUntilAction(1, false), CameraAction::kProbe);
  EXPECT_EQ(state(), CameraState::kLost);
}

TEST_F(CameraLife, ADeadCameraIsAskedAgainAndAgainAndNotTouched) {
  loseIt();
  for (int i = 0; i < 50; ++i) {
    answer(CameraAnswer::kNone);
    EXPECT_EQ(trouble(), CameraTrouble::kNoAnswer);
    EXPECT_EQ(step(), CameraAction::kNone);
    now_ += CameraMachine::kProbeEvery;
    ASSERT_EQ(step(), CameraAction::kProbe);
  }
}

TEST_F(CameraLife, ACameraThatForgotUsIsClosedOpenedAndProvenAgain) {
  loseIt();
  answer(CameraAnswer::kNone);
  now_ += CameraMachine::kProbeEvery;
  ASSERT_EQ(step(), CameraAction::kProbe);
  answer(CameraAnswer::kFree);
  EXPECT_EQ(state(), CameraState::kRecovering);
  ASSERT_EQ(step(), CameraAction::kClose);
  close();
  ASSERT_EQ(step(), CameraAction::kProbe) << "immediately";
  answer(CameraAnswer::kFree);
  openAndStart();
  EXPECT_EQ(state(), CameraState::kRecovering);
  EXPECT_EQ(fireUntilAction(CameraMachine::kProofTriggers + 4, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
}

TEST_F(CameraLife, ACameraThatWasAwayForAMomentGoesOnByItself) {
  loseIt();
  answer(CameraAnswer::kNone);
  EXPECT_EQ(fireUntilAction(1, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kRecovering);
  EXPECT_EQ(fireUntilAction(CameraMachine::kProofTriggers + 4, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
}

TEST_F(CameraLife, ACameraOfOursThatStaysSilentIsOpenedAgainOnceASecond) {
  loseIt();
  int closed = 0;
  const rt::Timestamp begin = now_;
  answer(CameraAnswer::kOurs);
  while (now_ - begin < seconds(10)) {
    fire(false);
    const CameraAction action = step();
    if (action == CameraAction::kProbe) answer(CameraAnswer::kOurs);
    if (action != CameraAction::kClose) continue;
    ++closed;
    close();
    EXPECT_EQ(trouble(), CameraTrouble::kSilent);
    ASSERT_EQ(step(), CameraAction::kProbe);
    answer(CameraAnswer::kFree);
    openAndStart();
    EXPECT_EQ(state(), CameraState::kLost) << "until it shows a frame";
  }
  EXPECT_GE(closed, 5);
  EXPECT_LE(closed, 10);
  EXPECT_EQ(fireUntilAction(CameraMachine::kProofTriggers + 4, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
}

TEST_F(CameraLife, ACameraThatAnotherProgramTookIsLetGo) {
  loseIt();
  answer(CameraAnswer::kHeld, "10.0.0.5");
  EXPECT_EQ(step(), CameraAction::kClose);
}

TEST_F(CameraLife, WaitsSilentlyForADeadControllersHeartbeat) {
  ASSERT_EQ(step(), CameraAction::kProbe);
  const rt::Timestamp begin = now_;
  while (now_ - begin < seconds(3)) {
    answer(CameraAnswer::kHeld);
    EXPECT_EQ(state(), CameraState::kConnecting);
    EXPECT_TRUE(machine_.settled());
    now_ += CameraMachine::kProbeEvery;
    ASSERT_EQ(step(), CameraAction::kProbe);
  }
  answer(CameraAnswer::kFree);
  EXPECT_EQ(step(), CameraAction::kOpen);
}

TEST_F(CameraLife, NamesALivingControllerAndTakesTheCameraWhenItIsFree) {
  ASSERT_EQ(step(), CameraAction::kProbe);
  for (int i = 0; i < 60; ++i) {
    answer(CameraAnswer::kHeld, "10.0.0.5");
    now_ += CameraMachine::kProbeEvery;
    ASSERT_EQ(step(), CameraAction::kProbe);
  }
  EXPECT_EQ(state(), CameraState::kLost);
  EXPECT_EQ(trouble(), CameraTrouble::kHeld);
  EXPECT_EQ(machine_.health().detail, "10.0.0.5");
  answer(CameraAnswer::kFree);
  EXPECT_EQ(state(), CameraState::kRecovering);
  openAndStart();
}

TEST_F(CameraLife, ARefusedProfileIsToldAndTriedOnceASecond) {
  ASSERT_EQ(step(), CameraAction::kProbe);
  answer(CameraAnswer::kFree);
  ASSERT_EQ(step(), CameraAction::kOpen);
  machine_.opened(now_, "refuses Width = 4096");
  EXPECT_TRUE(machine_.settled());
  EXPECT_EQ(trouble(), CameraTrouble::kRefuses);
  EXPECT_EQ(machine_.health().detail, "refuses Width = 4096");
  now_ += CameraMachine::kTryEvery - milliseconds(1);
  EXPECT_EQ(step(), CameraAction::kNone);
  now_ += milliseconds(1);
  ASSERT_EQ(step(), CameraAction::kProbe);
  answer(CameraAnswer::kFree);
  EXPECT_EQ(trouble(), CameraTrouble::kRefuses) << "until it shows a frame";
  openAndStart();
}

TEST_F(CameraLife, ARefusedStartLetsTheCameraGo) {
  ASSERT_EQ(step(), CameraAction::kProbe);
  answer(CameraAnswer::kFree);
  ASSERT_EQ(step(), CameraAction::kOpen);
  machine_.opened(now_, "");
  ASSERT_EQ(step(), CameraAction::kStart);
  machine_.started(now_, "no stream", facts_);
  ASSERT_EQ(step(), CameraAction::kClose);
  close();
  EXPECT_EQ(step(), CameraAction::kNone);
  now_ += CameraMachine::kTryEvery;
  EXPECT_EQ(step(), CameraAction::kProbe);
}

TEST_F(CameraLife, AFailedProofPushesTheProfileAgainThenTakesWhatComes) {
  connect();
  std::uint32_t starts = 1;
  for (std::uint32_t i = 0; i < 400; ++i) {
    fire(i % 2 == 0);
    const CameraAction action = step();
    if (action == CameraAction::kNone) continue;
    ASSERT_EQ(action, CameraAction::kClose);
    close();
    ASSERT_EQ(step(), CameraAction::kProbe);
    answer(CameraAnswer::kFree);
    openAndStart();
    ++starts;
  }
  EXPECT_EQ(starts, CameraMachine::kPushes);
  EXPECT_EQ(state(), CameraState::kDegraded);
  EXPECT_EQ(trouble(), CameraTrouble::kGaps);
  EXPECT_EQ(fireUntilAction(100, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
}

TEST_F(CameraLife, MoreFramesThanTriggersAreNoProof) {
  connect();
  bool closed = false;
  for (std::uint32_t i = 0; i < 60 && !closed; ++i) {
    fire(true);
    ++facts_.extra;  // a camera that runs free at twice the rate
    closed = step() == CameraAction::kClose;
    ASSERT_NE(state(), CameraState::kStreaming);
  }
  EXPECT_TRUE(closed);
}

TEST_F(CameraLife, FirstFramesThatCouldNotBeToldApartAreForgivenOnceOthersFollow) {
  connect();
  for (std::uint32_t i = 0; i < 40; ++i) {
    const bool told_apart = i >= 3;  // a machine that was busy at the beginning
    fire(told_apart);
    if (!told_apart) ++facts_.extra;
    ASSERT_EQ(step(), CameraAction::kNone) << "a camera that delivers every frame is left alone";
  }
  EXPECT_EQ(state(), CameraState::kStreaming);
}

TEST_F(CameraLife, FramesBesideThoseOfTriggersAreNoProofHoweverLongTheyAreWatched) {
  connect();
  CameraAction action = CameraAction::kNone;
  for (std::uint32_t i = 0; i < 60 && action == CameraAction::kNone; ++i) {
    fire(true);
    if (i % 3 == 0) ++facts_.extra;  // something else fires it, too
    action = step();
    ASSERT_NE(state(), CameraState::kStreaming);
  }
  EXPECT_EQ(action, CameraAction::kClose);
}

TEST_F(CameraLife, ALostFrameNowAndThenIsNoTrouble) {
  stream();
  for (std::uint32_t i = 1; i < 400; ++i) {
    fire(i % 20 != 0);
    ASSERT_EQ(step(), CameraAction::kNone);
    ASSERT_EQ(state(), CameraState::kStreaming);
  }
}

TEST_F(CameraLife, ManyMissingOrDamagedFramesDegradeAndItSaysWhich) {
  stream();
  for (std::uint32_t i = 0; i < 80; ++i) {
    fire(i % 2 == 0);
    ASSERT_EQ(step(), CameraAction::kNone) << "a degraded camera is left running";
  }
  EXPECT_EQ(state(), CameraState::kDegraded);
  EXPECT_EQ(trouble(), CameraTrouble::kGaps);
  for (std::uint32_t i = 0; i < 80; ++i) {
    fire(i % 2 == 0);
    if (i % 2 == 1) ++facts_.damaged;
    ASSERT_EQ(step(), CameraAction::kNone);
  }
  EXPECT_EQ(trouble(), CameraTrouble::kDamaged);
  EXPECT_EQ(fireUntilAction(80, true), CameraAction::kNone);
  EXPECT_EQ(state(), CameraState::kStreaming);
}

TEST_F(CameraLife, AShortHistoryStillProves) {
  connect();
  for (int i = 0; i < 20; ++i) {
    fire(true);
    facts_.judged = std::min(facts_.judged, 3U);
    facts_.brought &= 7;
    ASSERT_EQ(step(), CameraAction::kNone);
  }
  EXPECT_EQ(state(), CameraState::kStreaming);
}

}  // namespace

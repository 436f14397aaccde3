#include "appliance/journal/status_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/journal/log.h"

namespace {

using appliance::CameraState;
using appliance::CameraTrouble;
using appliance::GenlockReason;
using appliance::GenlockState;
using appliance::JournalLine;
using appliance::LogLevel;
using appliance::StatusJournal;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class JournalOfTwoCameras : public testing::Test {
 protected:
  JournalOfTwoCameras() {
    status.cameras.resize(2);
    status.cameras[0].name = "left";
    status.cameras[1].name = "right";
    for (std::size_t i = 0; i < status.cameras.size(); ++i) set(i, CameraState::kStreaming);
    EXPECT_THAT(look(0), IsEmpty());
  }

  void set(std::size_t i, CameraState state) {
    const bool lost = state == CameraState::kLost;
    status.cameras[i].state = state;
    status.cameras[i].trouble = lost ? CameraTrouble::kNoAnswer : CameraTrouble::kNone;
    status.cameras[i].reason = lost ? "no frames: check its cable" : "";
  }
  void lose(std::size_t camera, std::uint64_t frames) {
    status.cameras[camera].frames_lost += frames;
  }
  std::vector<std::string> look(int at_ms) {
    std::vector<std::string> texts;
    lines = journal.look(rt::fromNs(5'000'000'000) + milliseconds(at_ms), status);
    for (const JournalLine& line : lines) texts.push_back(line.text);
    return texts;
  }

  appliance::Status status;
  StatusJournal journal;
  std::vector<JournalLine> lines;
};

TEST_F(JournalOfTwoCameras, SaysNothingWhileAllIsWell) {
  for (int ms = 100; ms <= 20'000; ms += 100) EXPECT_THAT(look(ms), IsEmpty()) << ms;
}

TEST_F(JournalOfTwoCameras, SaysASilentCameraAsAWarningAndItsReturnAsANotice) {
  set(1, CameraState::kLost);
  EXPECT_THAT(look(100), ElementsAre(StartsWith("camera 2 (right): no frames: ")));
  EXPECT_EQ(lines.front().level, LogLevel::kWarning);
  EXPECT_THAT(look(200), IsEmpty());
  set(1, CameraState::kStreaming);
  EXPECT_THAT(look(300),
              ElementsAre("camera 2 (right): a frame for every trigger again (after 0.2 s)"));
  EXPECT_EQ(lines.front().level, LogLevel::kNotice);
  EXPECT_THAT(look(400), IsEmpty());
}

TEST_F(JournalOfTwoCameras, WaitsUntilTheReasonOfASilenceIsKnown) {
  status.cameras[1].state = CameraState::kLost;
  EXPECT_THAT(look(100), IsEmpty());
  set(1, CameraState::kLost);
  EXPECT_THAT(look(200), ElementsAre("camera 2 (right): no frames: check its cable"));
}

TEST_F(JournalOfTwoCameras, SaysNothingOfTheSameTroubleAgainUntilTheCameraStreams) {
  set(1, CameraState::kLost);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr("check its cable")));
  set(1, CameraState::kRecovering);
  EXPECT_THAT(look(200), IsEmpty());
  set(1, CameraState::kLost);
  status.cameras[1].reason = "no frames since 7.2 s: check its cable";
  EXPECT_THAT(look(300), IsEmpty());
}

TEST_F(JournalOfTwoCameras, SaysWhenALostCamerasTroubleTurnsIntoAnother) {
  set(1, CameraState::kLost);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr("check its cable")));
  status.cameras[1].trouble = CameraTrouble::kHeld;
  status.cameras[1].reason = "held by another program";
  EXPECT_THAT(look(200), ElementsAre("camera 2 (right): held by another program"));
  EXPECT_THAT(look(300), IsEmpty());
}

TEST_F(JournalOfTwoCameras, SaysTheFirstLossImmediatelyAndSumsFurtherOnesForFiveSeconds) {
  lose(0, 3);
  EXPECT_THAT(look(100), ElementsAre(StartsWith("camera 1 (left): 3 frames lost: ")));
  for (int ms = 200; ms < 5'100; ms += 100) {
    lose(0, 4);
    EXPECT_THAT(look(ms), IsEmpty()) << ms;
  }
  EXPECT_THAT(look(5'100), ElementsAre(HasSubstr(": 196 frames lost")));
  lose(0, 2);
  EXPECT_THAT(look(10'099), IsEmpty());
  EXPECT_THAT(look(10'100), ElementsAre(HasSubstr(": 2 frames lost")));
}

TEST_F(JournalOfTwoCameras, SaysALossImmediatelyAfterAQuietTime) {
  lose(0, 1);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr(": 1 frames lost")));
  EXPECT_THAT(look(5'100), IsEmpty());
  lose(0, 7);
  EXPECT_THAT(look(5'200), ElementsAre(HasSubstr(": 7 frames lost")));
}

TEST_F(JournalOfTwoCameras, OneCamerasLossesDoNotHideAnothers) {
  lose(0, 1);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr("(left): 1 frames lost")));
  lose(0, 5);
  lose(1, 2);
  EXPECT_THAT(look(200), ElementsAre(HasSubstr("(right): 2 frames lost")));
  EXPECT_THAT(look(5'100), ElementsAre(HasSubstr("(left): 5 frames lost")));
}

TEST_F(JournalOfTwoCameras, DoesNotCountWhatASilentCameraOwes) {
  lose(1, 1);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr(": 1 frames lost")));
  lose(1, 6);
  EXPECT_THAT(look(200), IsEmpty());
  set(1, CameraState::kLost);
  lose(1, 4);
  EXPECT_THAT(look(300), ElementsAre(HasSubstr("no frames")));
  lose(1, 4000);
  EXPECT_THAT(look(60'000), IsEmpty());
  set(1, CameraState::kStreaming);
  EXPECT_THAT(look(60'100),
              ElementsAre(HasSubstr("every trigger again"), HasSubstr(": 6 frames lost")));
}

TEST(StatusJournal, DoesNotCountWhatIsLostBeforeACameraStreams) {
  appliance::Status status;
  status.cameras.resize(1);
  status.cameras[0].frames_lost = 9;
  StatusJournal journal;
  EXPECT_THAT(journal.look(rt::fromNs(1'000'000'000), status), IsEmpty());
  status.cameras[0].state = CameraState::kStreaming;
  EXPECT_THAT(journal.look(rt::fromNs(1'100'000'000), status), IsEmpty());
}

std::vector<JournalLine> look(StatusJournal& journal, const appliance::Status& status, int ms) {
  return journal.look(rt::fromNs(1'000'000'000) + milliseconds(ms), status);
}

TEST(StatusJournal, SaysWhatBecomesLessThanConfiguredAndThatItIsOver) {
  StatusJournal journal;
  EXPECT_EQ(look(journal, {.degraded = {{"panel", "panel: gone for 1 s"}}}, 0).size(), 1u);
  EXPECT_TRUE(look(journal, {.degraded = {{"panel", "panel: gone for 2 s"}}}, 100).empty());
  EXPECT_THAT(look(journal, {}, 200),
              ElementsAre(JournalLine{LogLevel::kNotice, "over: panel: gone for 2 s (after 0.2 s)",
                                      appliance::Word::kOver}));
  EXPECT_EQ(look(journal, {.degraded = {{"panel", "panel: gone for 1 s"}}}, 300).size(), 1u);
}

TEST(StatusJournal, AReleasedScreenIsANoticeAndAMissingOneAWarning) {
  StatusJournal journal;
  EXPECT_TRUE(look(journal, {}, 0).empty());
  EXPECT_THAT(look(journal, {.screen = hal::ScreenState::kReleased}, 100),
              ElementsAre(JournalLine{LogLevel::kNotice, "screen: released",
                                      appliance::Word::kScreenState}));
  EXPECT_THAT(
      look(journal, {.screen = hal::ScreenState::kNoScreen, .screen_message = "connect one"}, 200),
      ElementsAre(JournalLine{LogLevel::kWarning, "screen: no screen: connect one"}));
  EXPECT_THAT(look(journal, {}, 300),
              ElementsAre(testing::Field(&JournalLine::text, StartsWith("screen: showing"))));
}

TEST(StatusJournal, SaysEveryLockAndLossAndNotTheWayToTheFirst) {
  StatusJournal journal;
  int ms = 0;
  const auto after = [&](GenlockState state, GenlockReason reason, std::uint64_t unlocks = 0) {
    appliance::Status status;
    status.genlock = {.state = state, .reason = reason, .unlocks = unlocks};
    status.genlock_text = "stands so";
    return look(journal, status, ms += 100);
  };
  EXPECT_THAT(after(GenlockState::kFreeRunning, GenlockReason::kNoVblanks), IsEmpty());
  EXPECT_THAT(after(GenlockState::kAcquiring, GenlockReason::kNone), IsEmpty());
  EXPECT_THAT(after(GenlockState::kLocked, GenlockReason::kNone),
              ElementsAre(JournalLine{LogLevel::kNotice, "genlock stands so"}));
  EXPECT_THAT(after(GenlockState::kLocked, GenlockReason::kNone), IsEmpty());
  const auto lost = after(GenlockState::kAcquiring, GenlockReason::kPhaseLost, 1);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost.front().level, LogLevel::kWarning);
  EXPECT_THAT(after(GenlockState::kAcquiring, GenlockReason::kPhaseLost, 1), IsEmpty());
  EXPECT_EQ(after(GenlockState::kLocked, GenlockReason::kNone, 1).size(), 1u);
  EXPECT_EQ(after(GenlockState::kLocked, GenlockReason::kNone, 2).size(), 1u)
      << "lost and found between two looks";
}

TEST(StatusJournal, SaysARatioThatCannotLock) {
  StatusJournal journal;
  appliance::Status status;
  status.genlock = {.state = GenlockState::kFreeRunning, .reason = GenlockReason::kRatio};
  EXPECT_EQ(look(journal, status, 0).size(), 1u);
  EXPECT_TRUE(look(journal, status, 100).empty());
}

TEST(Log, KnowsTheJournalByDeviceAndInodeNotByTheVariableAlone) {
  struct stat file{};
  file.st_dev = 9;
  file.st_ino = 12345;
  EXPECT_TRUE(appliance::isJournal("9:12345", file));
  EXPECT_FALSE(appliance::isJournal("9:12346", file));
  EXPECT_FALSE(appliance::isJournal("", file));
  EXPECT_FALSE(appliance::isJournal(nullptr, file));
}

TEST(StatusJournal, TellsRemarksApartByTheirWordsAndWritesTheirIds) {
  StatusJournal journal;
  const auto remark = [](unsigned sets) {
    return appliance::remarkOf(
        "history", appliance::phrase<appliance::Word::kHistoryShort>(sets, sets / 40.0, 300));
  };
  const auto lines = look(journal, {.degraded = {remark(200)}}, 0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(appliance::withId(lines[0]), StartsWith("[history-short] memory is short: "));
  EXPECT_TRUE(look(journal, {.degraded = {remark(100)}}, 100).empty()) << "the same, in numbers";
}

}  // namespace

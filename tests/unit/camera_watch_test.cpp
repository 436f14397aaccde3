#include "appliance/journal/camera_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/journal/degraded_watch.h"

namespace {

using appliance::CameraState;
using appliance::CameraTrouble;
using appliance::CameraWatch;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class CameraWatchOfTwo : public testing::Test {
 protected:
  CameraWatchOfTwo() {
    status.cameras.resize(2);
    status.cameras[0].name = "left";
    status.cameras[1].name = "right";
    setStates(CameraState::kStreaming);
    EXPECT_THAT(look(0), IsEmpty());
  }

  void setStates(CameraState state) {
    for (std::size_t i = 0; i < status.cameras.size(); ++i) set(i, state);
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
    return watch.look(status, rt::fromNs(5'000'000'000) + milliseconds(at_ms));
  }

  appliance::Status status;
  CameraWatch watch;
};

TEST_F(CameraWatchOfTwo, SaysNothingWhileAllIsWell) {
  for (int ms = 100; ms <= 20'000; ms += 100) EXPECT_THAT(look(ms), IsEmpty()) << ms;
}

TEST_F(CameraWatchOfTwo, TellsASilentCameraOnceAndItsReturnOnce) {
  set(1, CameraState::kLost);
  EXPECT_THAT(look(100), ElementsAre(StartsWith("camera 2 (right): no frames: ")));
  EXPECT_THAT(look(200), IsEmpty());
  set(1, CameraState::kStreaming);
  EXPECT_THAT(look(300), ElementsAre("camera 2 (right): a frame for every trigger again"));
  EXPECT_THAT(look(400), IsEmpty());
}

TEST_F(CameraWatchOfTwo, WaitsUntilTheReasonOfASilenceIsKnown) {
  status.cameras[1].state = CameraState::kLost;
  EXPECT_THAT(look(100), IsEmpty());
  set(1, CameraState::kLost);
  EXPECT_THAT(look(200), ElementsAre("camera 2 (right): no frames: check its cable"));
}

TEST_F(CameraWatchOfTwo, SaysNothingOfTheSameTroubleAgainUntilTheCameraStreams) {
  set(1, CameraState::kLost);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr("check its cable")));
  set(1, CameraState::kRecovering);
  EXPECT_THAT(look(200), IsEmpty());
  set(1, CameraState::kLost);
  status.cameras[1].reason = "no frames since 7.2 s: check its cable";
  EXPECT_THAT(look(300), IsEmpty());
}

TEST_F(CameraWatchOfTwo, TellsWhenALostCamerasTroubleTurnsIntoAnother) {
  set(1, CameraState::kLost);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr("check its cable")));
  status.cameras[1].trouble = CameraTrouble::kHeld;
  status.cameras[1].reason = "held by another program";
  EXPECT_THAT(look(200), ElementsAre("camera 2 (right): held by another program"));
  EXPECT_THAT(look(300), IsEmpty());
}

TEST_F(CameraWatchOfTwo, TellsEverySilenceHoweverSoonItFollows) {
  for (int i = 0; i < 3; ++i) {
    setStates(CameraState::kLost);
    EXPECT_THAT(look(100 + 200 * i), ElementsAre(HasSubstr("no frames"), HasSubstr("no frames")));
    setStates(CameraState::kStreaming);
    EXPECT_THAT(look(200 + 200 * i), ElementsAre(HasSubstr("again"), HasSubstr("again")));
  }
}

TEST_F(CameraWatchOfTwo, TellsTheFirstLossAtOnce) {
  lose(0, 3);
  EXPECT_THAT(look(100), ElementsAre(StartsWith("camera 1 (left): 3 frames lost: ")));
  EXPECT_THAT(look(200), IsEmpty());
}

TEST_F(CameraWatchOfTwo, SumsFurtherLossesForFiveSeconds) {
  lose(0, 1);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr(": 1 frames lost")));
  for (int ms = 200; ms < 5'100; ms += 100) {
    lose(0, 4);
    EXPECT_THAT(look(ms), IsEmpty()) << ms;
  }
  EXPECT_THAT(look(5'100), ElementsAre(HasSubstr(": 196 frames lost")));
  lose(0, 2);
  EXPECT_THAT(look(10'099), IsEmpty());
  EXPECT_THAT(look(10'100), ElementsAre(HasSubstr(": 2 frames lost")));
}

TEST_F(CameraWatchOfTwo, TellsALossAtOnceAfterAQuietTime) {
  lose(0, 1);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr(": 1 frames lost")));
  EXPECT_THAT(look(5'100), IsEmpty());
  lose(0, 7);
  EXPECT_THAT(look(5'200), ElementsAre(HasSubstr(": 7 frames lost")));
}

TEST_F(CameraWatchOfTwo, OneCamerasLossesDoNotHideAnothers) {
  lose(0, 1);
  EXPECT_THAT(look(100), ElementsAre(HasSubstr("(left): 1 frames lost")));
  lose(0, 5);
  lose(1, 2);
  EXPECT_THAT(look(200), ElementsAre(HasSubstr("(right): 2 frames lost")));
  EXPECT_THAT(look(5'100), ElementsAre(HasSubstr("(left): 5 frames lost")));
}

TEST_F(CameraWatchOfTwo, DoesNotCountWhatASilentCameraOwes) {
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

TEST(CameraWatch, DoesNotCountWhatIsLostBeforeACameraStreams) {
  appliance::Status status;
  status.cameras.resize(1);
  status.cameras[0].frames_lost = 9;
  CameraWatch watch;
  EXPECT_THAT(watch.look(status, rt::fromNs(1'000'000'000)), IsEmpty());
  status.cameras[0].state = CameraState::kStreaming;
  EXPECT_THAT(watch.look(status, rt::fromNs(1'100'000'000)), IsEmpty());
}

TEST(DegradedWatch, TellsEachLineOnceAndNoneOfTheStart) {
  appliance::DegradedWatch watch({"no real-time priority"});
  EXPECT_TRUE(watch.look({.degraded = {{"realtime", "no real-time priority"}}}).empty());
  EXPECT_THAT(
      watch.look({.degraded = {{"realtime", "no real-time priority"}, {"panel", "panel: gone"}}}),
      ElementsAre("panel: gone"));
  EXPECT_TRUE(watch.look({}).empty());
  EXPECT_TRUE(watch.look({.degraded = {{"panel", "panel: gone"}}}).empty());
}

}  // namespace

#include <gtest/gtest.h>

#include "appliance/capture/camera_state.h"

namespace {

using appliance::CameraState;
using appliance::CameraTrouble;
using appliance::textOf;
using appliance::Word;
using std::chrono::milliseconds;

std::string reasonOf(const appliance::CameraHealth& health,
                     std::optional<rt::Nanoseconds> silent_for) {
  return textOf(appliance::reasonOf(health, silent_for));
}

TEST(CameraReason, OfADeadCameraTellsSinceWhenAndWhatToCheck) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kNoAnswer}, milliseconds(400)),
            "no frames for 0.4 s: check its cable, its power and its switch port");
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kNoAnswer}, std::nullopt),
            "no answer: check its cable, its power and its switch port");
}

TEST(CameraReason, OfASilenceWithoutAKnownCauseIsTheSilence) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kNone}, milliseconds(125)),
            "no frames for 0.1 s");
}

TEST(CameraReason, OfASilentCameraThatAnswersNamesItsWire) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kSilent}, milliseconds(4000)),
            "no frames for 4.0 s although it answers: check its trigger wire");
  EXPECT_EQ(appliance::reasonOf({CameraState::kLost, CameraTrouble::kSilent}, {}).word,
            Word::kCameraSilentFromStart);
}

TEST(CameraReason, OfALostCameraWhoseFramesAreDamagedNamesThem) {
  EXPECT_EQ(
      appliance::reasonOf({CameraState::kLost, CameraTrouble::kDamaged}, milliseconds(900)).word,
      Word::kCameraLostDamaged);
}

TEST(CameraReason, NamesWhoHoldsTheCameraWhereThatIsKnown) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kHeld, "10.0.0.5"}, milliseconds(400)),
            "in use by another program (10.0.0.5): close it, the camera reconnects automatically");
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kHeld}, std::nullopt),
            "in use by another program: close it, the camera reconnects automatically");
}

TEST(CameraReason, IsTheCamerasOwnWhereItRefuses) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kRefuses, "refuses Width"}, std::nullopt),
            "refuses Width");
}

TEST(CameraReason, IsNothingWhereAllIsWell) {
  for (const CameraState state :
       {CameraState::kConnecting, CameraState::kStreaming, CameraState::kRecovering}) {
    EXPECT_EQ(reasonOf({state, CameraTrouble::kNone}, milliseconds(400)), "") << nameOf(state);
  }
}

TEST(CameraReason, OfADegradedCameraSaysWhatItsFramesLack) {
  for (const CameraTrouble trouble :
       {CameraTrouble::kGaps, CameraTrouble::kDamaged, CameraTrouble::kExtra}) {
    EXPECT_NE(reasonOf({CameraState::kDegraded, trouble}, milliseconds(1)).find("check"),
              std::string::npos);
  }
}

}  // namespace

#include <gtest/gtest.h>

#include "appliance/capture/camera_state.h"

namespace {

using appliance::CameraState;
using appliance::CameraTrouble;
using appliance::reasonOf;
using std::chrono::milliseconds;

TEST(CameraReason, OfADeadCameraTellsSinceWhenAndWhatToCheck) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kNoAnswer}, milliseconds(400)),
            "no frames since 0.4 s: check its cable, its power and its switch port");
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kNoAnswer}, std::nullopt),
            "no answer: check its cable, its power and its switch port");
}

TEST(CameraReason, OfASilenceWithoutAKnownCauseIsTheSilence) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kNone}, milliseconds(125)),
            "no frames since 0.1 s");
}

TEST(CameraReason, NamesWhoHoldsTheCameraWhereThatIsKnown) {
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kHeld, "10.0.0.5"}, milliseconds(400)),
            "held by another program at 10.0.0.5: end that program; the camera then comes by "
            "itself");
  EXPECT_EQ(reasonOf({CameraState::kLost, CameraTrouble::kHeld}, std::nullopt),
            "held by another program: end that program; the camera then comes by itself");
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

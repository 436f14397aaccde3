#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/capture/genlock_text.h"

namespace {

using appliance::GenlockReason;
using appliance::GenlockState;
using appliance::genlockText;
using testing::HasSubstr;

std::string ratioText(double trigger_hz, double refresh_hz) {
  return genlockText({.state = GenlockState::kFreeRunning,
                      .reason = GenlockReason::kRatio,
                      .vblank_period_ns = 1e9 / refresh_hz},
                     trigger_hz);
}

TEST(GenlockText, NamesTheRatioAndTheRatesThatWouldLock) {
  EXPECT_EQ(ratioText(40, 60),
            "free-running: triggers of 40 Hz on a screen of 60 Hz are 2 to 3; trigger.rate_hz = 30 "
            "or 60 would lock");
  EXPECT_THAT(ratioText(50, 59.94),
              HasSubstr("5 to 6; trigger.rate_hz = 29.97 or 59.94 would lock"));
  EXPECT_THAT(ratioText(120, 60), HasSubstr("2 to 1; trigger.rate_hz = 60 would lock"));
  EXPECT_THAT(ratioText(61, 60), HasSubstr("in no simple ratio; trigger.rate_hz = 60 would lock"));
  EXPECT_THAT(ratioText(59, 60), HasSubstr("in no simple ratio; trigger.rate_hz = 30 or 60"));
}

TEST(GenlockText, SaysHowALockStands) {
  const std::string text = genlockText({.state = GenlockState::kLocked,
                                        .hold_over = true,
                                        .vblanks_per_trigger = 2,
                                        .phase_error_rms_ns = 6400,
                                        .lead = std::chrono::microseconds(25040),
                                        .vblank_period_ns = 12.5e6},
                                       40);
  EXPECT_EQ(text,
            "locked: a trigger every 2 vblanks of 80 Hz, 6.4 us rms off, page flip 25.0 ms after "
            "the trigger; held over, no page flips at present");
}

TEST(GenlockText, HasALineForEveryState) {
  EXPECT_THAT(genlockText({}, 40), HasSubstr("off"));
  for (const auto reason : {GenlockReason::kNoVblanks, GenlockReason::kNoFrames})
    EXPECT_THAT(genlockText({.state = GenlockState::kFreeRunning, .reason = reason}, 40),
                HasSubstr("free-running: "));
  for (const auto reason : {GenlockReason::kNone, GenlockReason::kPhaseLost})
    EXPECT_THAT(genlockText({.state = GenlockState::kAcquiring, .reason = reason}, 40),
                HasSubstr("acquiring: "));
}

}  // namespace

#include "appliance/journal/genlock_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/capture/genlock_text.h"

namespace {

using appliance::GenlockReason;
using appliance::GenlockState;
using appliance::genlockText;
using appliance::GenlockWatch;
using appliance::Status;
using testing::HasSubstr;
using testing::Optional;

Status statusOf(GenlockState state, GenlockReason reason, std::uint64_t unlocks = 0) {
  Status status;
  status.genlock = {.state = state, .reason = reason, .unlocks = unlocks};
  status.genlock_text = "stands so";
  return status;
}

TEST(GenlockWatch, TellsEveryLockAndLossOnceAndNotTheWayToTheFirst) {
  GenlockWatch watch;
  const auto look = [&](GenlockState state, GenlockReason reason, std::uint64_t unlocks = 0) {
    return watch.look(statusOf(state, reason, unlocks));
  };
  EXPECT_EQ(look(GenlockState::kFreeRunning, GenlockReason::kNoVblanks), std::nullopt);
  EXPECT_EQ(look(GenlockState::kFreeRunning, GenlockReason::kNoFrames), std::nullopt);
  EXPECT_EQ(look(GenlockState::kAcquiring, GenlockReason::kNone), std::nullopt);
  EXPECT_THAT(look(GenlockState::kLocked, GenlockReason::kNone), Optional(HasSubstr("stands so")));
  EXPECT_EQ(look(GenlockState::kLocked, GenlockReason::kNone), std::nullopt);
  EXPECT_NE(look(GenlockState::kAcquiring, GenlockReason::kPhaseLost, 1), std::nullopt);
  EXPECT_EQ(look(GenlockState::kAcquiring, GenlockReason::kPhaseLost, 1), std::nullopt);
  EXPECT_NE(look(GenlockState::kLocked, GenlockReason::kNone, 1), std::nullopt);
  EXPECT_NE(look(GenlockState::kLocked, GenlockReason::kNone, 2), std::nullopt)
      << "lost and found between two looks";
}

TEST(GenlockWatch, TellsARatioThatCannotLock) {
  GenlockWatch watch;
  EXPECT_NE(watch.look(statusOf(GenlockState::kFreeRunning, GenlockReason::kRatio)), std::nullopt);
  EXPECT_EQ(watch.look(statusOf(GenlockState::kFreeRunning, GenlockReason::kRatio)), std::nullopt);
}

std::string ratioText(double trigger_hz, double refresh_hz) {
  return genlockText({.state = GenlockState::kFreeRunning,
                      .reason = GenlockReason::kRatio,
                      .vblank_period_ns = 1e9 / refresh_hz},
                     trigger_hz);
}

TEST(GenlockText, NamesTheRatioAndTheRatesThatWouldLock) {
  EXPECT_EQ(ratioText(40, 60),
            "free-running: triggers of 40 Hz on a screen of 60 Hz are 2:3: trigger.rate_hz = 30 or "
            "60 would lock");
  EXPECT_THAT(ratioText(50, 59.94), HasSubstr("5:6: trigger.rate_hz = 29.97 or 59.94 would lock"));
  EXPECT_THAT(ratioText(120, 60), HasSubstr("2:1: trigger.rate_hz = 60 would lock"));
  EXPECT_THAT(ratioText(61, 60), HasSubstr("in no simple ratio: trigger.rate_hz = 60 would lock"));
  EXPECT_THAT(ratioText(59, 60), HasSubstr("in no simple ratio: trigger.rate_hz = 30 or 60"));
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
            "the trigger; held over, no page flips just now");
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

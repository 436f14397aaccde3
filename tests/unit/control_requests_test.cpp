#include "appliance/control/control_requests.h"

#include <chrono>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::Command;
using appliance::Mode;
using appliance::Status;
using std::chrono::milliseconds;
using testing::HasSubstr;

Status running(Mode mode) {
  Status status;
  status.mode = mode;
  status.history_ms = 7500;
  status.cameras.resize(20);
  return status;
}

TEST(ControlRequests, AModeIsACommandThatNamesTheStateAndNeverAToggle) {
  EXPECT_EQ(appliance::requestMode("frozen").value(), Command{Command::Kind::kFreeze});
  EXPECT_EQ(appliance::requestMode("sweep").value(), Command{Command::Kind::kStartSweep});
  EXPECT_EQ(appliance::requestMode("live").value(), Command{Command::Kind::kGoLive});
}

TEST(ControlRequests, RefusesUnknownModesByNamingTheKnownOnes) {
  EXPECT_THAT(appliance::requestMode("Live").error(), HasSubstr("live, delayed, frozen and sweep"));
  EXPECT_THAT(appliance::requestMode("delayed").error(), HasSubstr("set a delay"));
}

TEST(ControlRequests, EveryOutcomeButSuccessHasALine) {
  using enum appliance::CommandOutcome;
  EXPECT_EQ(appliance::refusalOf(kApplied), "");
  for (const auto outcome : {kNoPictureYet, kNoSuchView, kAtMemorysEnd, kNothingNewer})
    EXPECT_NE(appliance::refusalOf(outcome), "");
}

TEST(ControlRequests, ViewsCountFromOne) {
  const Status now = running(Mode::kLive);
  EXPECT_EQ(*appliance::requestView(1, now),
            (Command{.kind = Command::Kind::kSetView, .camera = 0}));
  EXPECT_EQ(*appliance::requestView(20, now),
            (Command{.kind = Command::Kind::kSetView, .camera = 19}));
  EXPECT_THAT(appliance::requestView(0, now).error(), HasSubstr("the views are 1 to 20"));
  EXPECT_FALSE(appliance::requestView(21, now).has_value());
  EXPECT_FALSE(appliance::requestView(std::numeric_limits<std::uint32_t>::max(), now).has_value());
}

TEST(ControlRequests, ADelayReachesAtMostToTheHistorysEnd) {
  const Status now = running(Mode::kLive);
  const auto oldest = appliance::requestDelay(7500, now);
  ASSERT_TRUE(oldest.has_value()) << oldest.error();
  EXPECT_EQ(oldest->delay, milliseconds(7500));
  EXPECT_THAT(appliance::requestDelay(7501, now).error(), HasSubstr("the stored 7500 ms"));
}

TEST(ControlRequests, ATargetIsThreeFiniteCoordinatesInTheHall) {
  EXPECT_EQ(appliance::requestTarget(1, -2.5, 0).value(), (std::array<double, 3>{1, -2.5, 0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THAT(appliance::requestTarget(nan, 0, 1).error(), HasSubstr("three coordinates"));
  EXPECT_FALSE(appliance::requestTarget(0, infinite, 1).has_value());
  EXPECT_FALSE(appliance::requestTarget(0, 0, -infinite).has_value());
  EXPECT_FALSE(appliance::requestTarget(0, 0, 1e300).has_value());
}

}  // namespace

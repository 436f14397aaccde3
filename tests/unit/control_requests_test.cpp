#include "appliance/control/control_requests.h"

#include <chrono>
#include <cmath>
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

TEST(ControlRequests, EveryOutcomeButSuccessHasALine) {
  using enum appliance::CommandOutcome;
  EXPECT_TRUE(appliance::refusalOf(kApplied).empty());
  for (const auto outcome : {kNoPictureYet, kNoSuchView, kAtMemorysEnd, kNothingNewer})
    EXPECT_FALSE(appliance::refusalOf(outcome).empty());
}

TEST(ControlRequests, AModeIsACommandThatNamesAState) {
  EXPECT_EQ(*appliance::requestMode("live"), Command{Command::Kind::kGoLive});
  EXPECT_EQ(*appliance::requestMode("frozen"), Command{Command::Kind::kFreeze});
  EXPECT_EQ(*appliance::requestMode("sweep"), Command{Command::Kind::kStartSweep});
}

TEST(ControlRequests, RefusesUnknownModesByNamingTheKnownOnes) {
  EXPECT_THAT(textOf(appliance::requestMode("Live").error()),
              HasSubstr("live, delayed, slow, frozen and sweep"));
  EXPECT_THAT(textOf(appliance::requestMode("delayed").error()), HasSubstr("set a delay"));
  EXPECT_THAT(textOf(appliance::requestMode("slow").error()), HasSubstr("set a speed"));
}

TEST(ControlRequests, SpeedsHaveNames) {
  EXPECT_EQ(*appliance::requestSpeed("1/4"),
            (Command{.kind = Command::Kind::kSetRate, .rate = appliance::Rate::kQuarter}));
  EXPECT_THAT(textOf(appliance::requestSpeed("0.25").error()), HasSubstr("1, 1/2, 1/4, 1/8 and 0"));
}

TEST(ControlRequests, AComparisonNeedsAKnownLayoutAndSomethingElseToShow) {
  Status now = running(Mode::kLive);
  now.history_ms = 5000;
  using appliance::requestCompare;
  EXPECT_THAT(textOf(requestCompare("beside", 3, 0, 0.5, now).error()), HasSubstr("side-by-side"));
  EXPECT_THAT(textOf(requestCompare("ghost", 0, 0, 0.5, now).error()),
              HasSubstr("name another view"));
  EXPECT_THAT(textOf(requestCompare("ghost", 21, 0, 0.5, now).error()), HasSubstr("no view 21"));
  EXPECT_THAT(textOf(requestCompare("wipe", 0, 6000, 0.5, now).error()), HasSubstr("longer than"));
  for (const double share : {-0.1, 1.1, std::nan("")})
    EXPECT_THAT(textOf(requestCompare("wipe", 3, 0, share, now).error()), HasSubstr("from 0 to 1"));
  EXPECT_EQ(*requestCompare("wipe", 3, 1000, 0.25, now),
            (Command{.kind = Command::Kind::kCompare,
                     .camera = 2,
                     .delay = std::chrono::milliseconds(1000),
                     .composition = {.layout = appliance::Layout::kWipe, .share = 0.25F}}));
  EXPECT_EQ(requestCompare("ghost", 0, 1000, 0.5, now)->camera, Command::kSameView);
  EXPECT_EQ(requestCompare("single", 99, 9000, 7, now)->composition, appliance::Composition{});
}

TEST(ControlRequests, AReplayNeedsASpeedAndStoredTime) {
  const Status now = running(Mode::kLive);
  EXPECT_EQ(*appliance::requestReplay(3000, "1/2", now), (Command{.kind = Command::Kind::kReplay,
                                                                  .delay = milliseconds(3000),
                                                                  .rate = appliance::Rate::kHalf}));
  EXPECT_THAT(textOf(appliance::requestReplay(3000, "0", now).error()), HasSubstr("no end"));
  EXPECT_THAT(textOf(appliance::requestReplay(8000, "1", now).error()), HasSubstr("longer than"));
}

TEST(ControlRequests, ViewsCountFromOne) {
  const Status now = running(Mode::kLive);
  EXPECT_EQ(*appliance::requestView(1, now),
            (Command{.kind = Command::Kind::kSetView, .camera = 0}));
  EXPECT_EQ(*appliance::requestView(20, now),
            (Command{.kind = Command::Kind::kSetView, .camera = 19}));
  EXPECT_THAT(textOf(appliance::requestView(0, now).error()), HasSubstr("the views are 1 to 20"));
  EXPECT_FALSE(appliance::requestView(21, now).has_value());
  EXPECT_FALSE(appliance::requestView(std::numeric_limits<std::uint32_t>::max(), now).has_value());
}

TEST(ControlRequests, ADelayReachesAtMostToTheHistorysEnd) {
  const Status now = running(Mode::kLive);
  const auto oldest = appliance::requestDelay(7500, now);
  ASSERT_TRUE(oldest.has_value()) << textOf(oldest.error());
  EXPECT_EQ(oldest->delay, milliseconds(7500));
  EXPECT_THAT(textOf(appliance::requestDelay(7501, now).error()), HasSubstr("the stored 7500 ms"));
}

TEST(ControlRequests, ATargetIsThreeFiniteCoordinatesInTheHall) {
  EXPECT_EQ(appliance::requestTarget(1, -2.5, 0).value(), (std::array<double, 3>{1, -2.5, 0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THAT(textOf(appliance::requestTarget(nan, 0, 1).error()), HasSubstr("three coordinates"));
  EXPECT_FALSE(appliance::requestTarget(0, infinite, 1).has_value());
  EXPECT_FALSE(appliance::requestTarget(0, 0, -infinite).has_value());
  EXPECT_FALSE(appliance::requestTarget(0, 0, 1e300).has_value());
}

}  // namespace

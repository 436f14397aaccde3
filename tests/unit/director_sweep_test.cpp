#include <array>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/director_fixture.h"

namespace director_test {
namespace {

TEST_F(DirectorOnAnArcOfFive, SweepVisitsEveryViewOfOneMomentAndReturns) {
  (void)tick();
  std::vector<std::uint32_t> walk = {press(kSweep).camera_shown};
  for (int i = 0; i < 8; ++i) {
    history.newest += 2;
    const Shot shot = tick({}, milliseconds(50));  // 20 views a second
    EXPECT_EQ(shot.trigger, 1000u);
    walk.push_back(shot.camera_shown);
    EXPECT_EQ(shot.mode, i < 7 ? Mode::kSweep : Mode::kFrozen);
  }
  EXPECT_EQ(walk, (std::vector<std::uint32_t>{2, 3, 4, 3, 2, 1, 0, 1, 2}));
}

TEST_F(DirectorOnAnArcOfFive, SweepKeepsItsDurationWhenTicksComeLate) {
  (void)tick();
  (void)press(kSweep);
  EXPECT_EQ(tick({}, milliseconds(250)).camera_shown, 1u);
  EXPECT_EQ(tick({}, milliseconds(150)).mode, Mode::kFrozen);
}

TEST_F(DirectorOnAnArcOfFive, FreezeOrSweepStopASweepAtTheViewItHasReached) {
  for (const auto stop : {kFreezeToggle, kSweep}) {
    (void)setView(2);
    (void)press(kSweep);
    (void)tick({}, milliseconds(100));
    const Shot shot = press(stop);
    EXPECT_EQ(shot.mode, Mode::kFrozen);
    EXPECT_EQ(shot.camera_shown, 4u);
    (void)press(kGoLive);
  }
}

TEST_F(DirectorOnAnArcOfFive, ViewAndStepKeysGoOnFromWhereTheyStopASweep) {
  (void)tick();
  (void)press(kSweep);
  (void)tick({}, milliseconds(100));
  EXPECT_EQ(press(kViewLeft).camera_shown, 3u);
  (void)press(kSweep);
  (void)tick({}, milliseconds(50));
  const Shot shot = press(kStepBack);
  EXPECT_EQ(shot.camera_shown, 4u);
  EXPECT_EQ(shot.trigger, 999u);
}

TEST_F(DirectorOnAnArcOfFive, LeavingTheMomentDuringASweepReturnsToItsFirstView) {
  for (const auto leave : {kGoLive, kDelayMore}) {
    (void)setView(2);
    (void)press(kSweep);
    (void)tick({}, milliseconds(100));
    EXPECT_EQ(press(leave).camera_shown, 2u);
    (void)press(kGoLive);
  }
}

TEST_F(DirectorOnAnArcOfFive, SweepPassesOverViewsThatLackTheMoment) {
  (void)tick();
  history.holes = {{3, 1000}};
  (void)press(kSweep);
  Shot shot = tick({}, milliseconds(45));
  EXPECT_EQ(shot.camera_wanted, 2u);
  EXPECT_EQ(shot.substitute, Substitute::kNone);
  shot = tick({}, milliseconds(10));
  EXPECT_EQ(shot.camera_wanted, 4u);
  EXPECT_EQ(shot.substitute, Substitute::kNone);
}

TEST_F(DirectorOnAnArcOfFive, ASweepGoesByTheAnglesOfTheRig) {
  const std::array azimuths_deg{0.0, 10.0, 20.0, 30.0, 80.0};
  director.setArc(appliance::ArcPath(azimuths_deg));
  (void)tick();
  (void)press(kSweep);  // 20 views of 20 degrees a second: 60 degrees to the end in 150 ms
  EXPECT_EQ(tick({}, milliseconds(50)).camera_wanted, 3u);
  EXPECT_EQ(tick({}, milliseconds(49)).camera_wanted, 4u);
}

}  // namespace
}  // namespace director_test

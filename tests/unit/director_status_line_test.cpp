#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "appliance/director/status_line.h"

namespace {

using appliance::Mode;
using appliance::Shot;
using appliance::statusText;
using appliance::Substitute;
using std::chrono::milliseconds;

std::string line(const Shot& shot) {
  return statusText(shot, 20).text;
}

TEST(StatusLine, NamesModeDelayAndViewCountedFromOne) {
  Shot shot{.camera_wanted = 6, .camera_shown = 6, .trigger = 9};
  EXPECT_EQ(line(shot), "LIVE   view 7/20");
  shot.mode = Mode::kDelayed;
  shot.delay = milliseconds(3000);
  EXPECT_EQ(line(shot), "DELAY 3.0 s   view 7/20");
  shot.mode = Mode::kFrozen;
  shot.delay = milliseconds(4250);
  EXPECT_EQ(line(shot), "FROZEN -4.25 s   view 7/20");
  shot.mode = Mode::kSweep;
  shot.delay = milliseconds(50);
  EXPECT_EQ(line(shot), "SWEEP -0.05 s   view 7/20");
}

TEST(StatusLine, RoundsSecondsAcrossTheDecimalPoint) {
  Shot shot{.mode = Mode::kDelayed, .trigger = 9, .delay = milliseconds(1999)};
  EXPECT_EQ(line(shot), "DELAY 2.0 s   view 1/20");
  shot.mode = Mode::kFrozen;
  EXPECT_EQ(line(shot), "FROZEN -2.00 s   view 1/20");
}

TEST(StatusLine, GivesTheNewestMomentNoAge) {
  Shot shot{.mode = Mode::kFrozen, .trigger = 9, .delay = milliseconds(4)};
  EXPECT_EQ(line(shot), "FROZEN   view 1/20");
  shot.mode = Mode::kSweep;
  EXPECT_EQ(line(shot), "SWEEP   view 1/20");
}

TEST(StatusLine, SaysWhatIsShownInPlaceOfTheWantedView) {
  Shot shot{.substitute = Substitute::kLost, .camera_wanted = 6, .camera_shown = 7, .trigger = 9};
  EXPECT_EQ(line(shot), "LIVE   view 7/20   camera 7 lost: showing 8");
  EXPECT_TRUE(statusText(shot, 20).warning);
  shot.substitute = Substitute::kNoFrame;
  EXPECT_EQ(line(shot), "LIVE   view 7/20   camera 7 has no picture of this moment: showing 8");
  shot.substitute = Substitute::kLost;
  shot.camera_shown = 6;
  EXPECT_EQ(line(shot), "LIVE   view 7/20   camera 7 lost: showing its last picture");
}

TEST(StatusLine, NamesTheRateOfSlowMotionAndHowLongAgoItIs) {
  Shot shot{.mode = Mode::kSlow, .trigger = 9, .delay = milliseconds(1250)};
  shot.rate = appliance::Rate::kQuarter;
  const std::string rate(nameOf(shot.rate));
  EXPECT_EQ(line(shot), "SLOW " + rate + " -1.25 s   view 1/20");
  shot.delay = {};
  EXPECT_EQ(line(shot), "SLOW " + rate + "   view 1/20");
}

TEST(StatusLine, SaysThatAViewCannotSeeTheTarget) {
  const Shot shot{
      .substitute = Substitute::kCannotSee, .camera_wanted = 6, .camera_shown = 7, .trigger = 9};
  EXPECT_EQ(line(shot), "LIVE   view 7/20   camera 7 cannot see the target: showing 8");
}

TEST(StatusLine, IsNoBadgeWhileAllIsAsAskedFor) {
  const Shot shot{.mode = Mode::kFrozen, .trigger = 9};
  EXPECT_FALSE(statusText(shot, 20).warning);
}

TEST(StatusLine, SaysWhatThePictureIsComparedWith) {
  Shot shot{.trigger = 90, .second = {.camera = 4, .trigger = 90}};
  EXPECT_EQ(line(shot), "LIVE   view 1/20   with view 5");
  shot.second_earlier = milliseconds(4000);
  EXPECT_EQ(line(shot), "LIVE   view 1/20   with view 5, 4.00 s earlier");
  shot.second = {};
  shot.second_missing = true;
  EXPECT_EQ(line(shot), "LIVE   view 1/20   the picture to compare with is not stored");
}

TEST(StatusLine, SaysThatTheMemoryEndsHere) {
  const Shot shot{
      .mode = Mode::kFrozen, .at_history_end = true, .trigger = 9, .delay = milliseconds(7400)};
  EXPECT_EQ(line(shot), "FROZEN -7.40 s   view 1/20   end of memory");
}

TEST(StatusLine, SaysThatThereIsNoPictureYet) {
  const Shot shot{};
  EXPECT_EQ(line(shot), "LIVE   view 1/20   no picture yet");
  EXPECT_TRUE(statusText(shot, 20).warning);
}

TEST(StatusLine, TakesWhateverNumbers) {
  const Shot shot{.mode = Mode::kFrozen,
                  .substitute = Substitute::kNoFrame,
                  .at_history_end = true,
                  .camera_wanted = std::numeric_limits<std::uint32_t>::max() - 1,
                  .camera_shown = 0,
                  .trigger = 1,
                  .delay = rt::Nanoseconds::max() / 2};
  const auto status = statusText(shot, std::numeric_limits<std::uint32_t>::max());
  EXPECT_TRUE(status.text.starts_with("FROZEN -4611686018.43 s   view 4294967295/4294967295"));
}

}  // namespace

#include "appliance/status/screen_text.h"

#include <cerrno>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using hal::ScreenTrouble;
using testing::HasSubstr;

std::string textOf(ScreenTrouble trouble, int os_errno = 0) {
  hal::ScreenStatus screen{.trouble = trouble, .os_errno = os_errno};
  hal::putText(screen.subject, "HDMI-A-1");
  hal::putText(screen.detail, "1920x1080 at 60.00 Hz");
  return appliance::textOf(appliance::screenPhrase(screen));
}

TEST(ScreenText, SaysNothingWhileAllIsWell) {
  EXPECT_EQ(textOf(ScreenTrouble::kNone), "");
}

TEST(ScreenText, HasASentenceForEachTrouble) {
  for (int i = 1; i <= static_cast<int>(ScreenTrouble::kNoDisplay); ++i)
    EXPECT_NE(textOf(static_cast<ScreenTrouble>(i)), "") << i;
}

TEST(ScreenText, NamesConnectorModeAndCause) {
  EXPECT_EQ(textOf(ScreenTrouble::kModeRefused, ERANGE),
            "the driver refused 1920x1080 at 60.00 Hz on HDMI-A-1 (Numerical result out of range): "
            "try another cable, port or display.mode");
  EXPECT_THAT(textOf(ScreenTrouble::kNothingConnected), HasSubstr("connect one"));
}

TEST(ScreenText, KeepsAsMuchOfALongNameAsHasRoom) {
  hal::ScreenStatus screen;
  hal::putText(screen.subject, std::string(1000, 'x'));
  EXPECT_EQ(std::string(screen.subject.data()).size(), screen.subject.size() - 1);
}

}  // namespace

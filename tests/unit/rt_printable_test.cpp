#include <gtest/gtest.h>

#include "rt/printable.h"

namespace {

using rt::printable;

TEST(Printable, LeavesTextsOfPeopleAsTheyAre) {
  EXPECT_EQ(printable("camera 7: \"Straße\", 鏡, 😀"), "camera 7: \"Straße\", 鏡, 😀");
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, ShowsControlCharactersAsAQuestionMark) {
  EXPECT_EQ(printable("a\nb\tc\x1b[2J\x7f"), "a?b?c?[2J?");
  EXPECT_EQ(printable(std::string_view("\0x", 2)), "?x");
  EXPECT_EQ(printable("\xc2\x85"), "??");  // a line break of C1
}

TEST(Printable, ShowsBytesThatAreNotUtf8AsQuestionMarks) {
  EXPECT_EQ(printable("\xff|\xc3|\xc0\xaf|\xe9"), "?|?|??|?");
  EXPECT_EQ(printable("\xed\xa0\x80"), "???");       // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????");  // beyond the last code point
  EXPECT_EQ(printable("\xe2\x82"), "??");            // cut off
}

TEST(Printable, CutsALongTextBetweenCharacters) {
  EXPECT_EQ(printable("abcdef", 4), "abcd...");
  EXPECT_EQ(printable("abcä", 4), "abc...");
  EXPECT_EQ(printable("abcd", 4), "abcd");
}

}  // namespace

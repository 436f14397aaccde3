#include <gtest/gtest.h>

#include "rt/edit_distance.h"

namespace {

using rt::editDistance;

TEST(EditDistance, CountsLettersToInsertRemoveOrReplace) {
  EXPECT_EQ(editDistance("", ""), 0U);
  EXPECT_EQ(editDistance("", "abc"), 3U);
  EXPECT_EQ(editDistance("rate_hz", "rate_hz"), 0U);
  EXPECT_EQ(editDistance("rate_hx", "rate_hz"), 1U);
  EXPECT_EQ(editDistance("rat_hz", "rate_hz"), 1U);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
}

TEST(EditDistance, IsTheSameFromEitherSide) {
  EXPECT_EQ(editDistance("trigger", "tiger"), editDistance("tiger", "trigger"));
}

}  // namespace

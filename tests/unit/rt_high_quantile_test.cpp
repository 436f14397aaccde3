#include <gtest/gtest.h>

#include "rt/high_quantile.h"

namespace {

using rt::HighQuantile;
using rt::Nanoseconds;

TEST(HighQuantile, IsZeroBeforeAnything) {
  const HighQuantile quantile;
  EXPECT_EQ(quantile.count(), 0u);
  EXPECT_EQ(quantile.high(), Nanoseconds{0});
}

TEST(HighQuantile, IsTheSlowestOfAFew) {
  HighQuantile quantile;
  for (const int ns : {5, 9, 7}) quantile.add(Nanoseconds{ns});
  EXPECT_EQ(quantile.high(), Nanoseconds{9});
}

TEST(HighQuantile, IsANearestRankThatFiveOfAHundredExceed) {
  HighQuantile quantile;
  for (int ns = 100; ns >= 1; --ns) quantile.add(Nanoseconds{ns});
  EXPECT_EQ(quantile.high(), Nanoseconds{95});
}

TEST(HighQuantile, IsNotMovedByOneSlowDuration) {
  HighQuantile quantile;
  for (int i = 0; i < 20; ++i) quantile.add(Nanoseconds{i == 7 ? 900 : 10});
  EXPECT_EQ(quantile.high(), Nanoseconds{10});
}

TEST(HighQuantile, ForgetsWhatIsLongAgo) {
  HighQuantile quantile;
  for (int i = 0; i < 200; ++i) quantile.add(Nanoseconds{1000});
  for (int i = 0; i < 122; ++i) quantile.add(Nanoseconds{10});
  EXPECT_EQ(quantile.high(), Nanoseconds{10});
  EXPECT_EQ(quantile.count(), 128u);
}

}  // namespace

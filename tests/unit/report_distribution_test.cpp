#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/tools/distribution.h"

namespace {

using appliance::distributionOf;

TEST(DistributionOf, TakesNearestRankPercentilesOfAKnownSeries) {
  std::vector<double> values(1000);
  std::iota(values.rbegin(), values.rend(), 1.0);  // 1000 .. 1, unsorted on purpose
  const auto d = distributionOf(values);
  EXPECT_EQ(d.count, 1000u);
  EXPECT_DOUBLE_EQ(d.mean, 500.5);
  EXPECT_NEAR(d.sd, 288.819436, 1e-6);  // sqrt(1000 * 1001 / 12)
  EXPECT_EQ(d.p50, 500.0);
  EXPECT_EQ(d.p99, 990.0);
  EXPECT_EQ(d.p999, 999.0);
  EXPECT_EQ(d.max, 1000.0);
}

TEST(DistributionOf, IsTheValueItselfForOneValue) {
  const auto d = distributionOf({4.25});
  EXPECT_EQ(d.count, 1u);
  EXPECT_EQ(d.sd, 0.0);
  for (const double p : {d.mean, d.p50, d.p99, d.p999, d.max}) EXPECT_EQ(p, 4.25);
}

TEST(DistributionOf, IsEmptyForNoValues) {
  const auto d = distributionOf({});
  EXPECT_EQ(d.count, 0u);
  for (const double p : {d.mean, d.sd, d.p50, d.p99, d.p999, d.max}) EXPECT_EQ(p, 0.0);
}

}  // namespace

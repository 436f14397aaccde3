#include <array>
#include <memory>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "rt/statistics.h"

namespace {

using rt::Nanoseconds;

/// On the heap: 18 KiB each.
std::unique_ptr<rt::CycleStatistics> recorded(const std::vector<std::int64_t>& values_ns) {
  auto statistics = std::make_unique<rt::CycleStatistics>();
  for (const auto ns : values_ns) statistics->record(Nanoseconds{ns});
  return statistics;
}

TEST(DistributionOf, TakesNearestRankPercentilesOfAKnownSeries) {
  std::vector<double> values(1000);
  std::iota(values.rbegin(), values.rend(), 1.0);  // 1000 .. 1, unsorted on purpose
  const auto d = rt::distributionOf(values);
  EXPECT_EQ(d.count, 1000u);
  EXPECT_DOUBLE_EQ(d.mean, 500.5);
  EXPECT_NEAR(d.sd, 288.674990, 1e-6);  // sqrt((1000^2 - 1) / 12)
  EXPECT_EQ(d.p50, 500.0);
  EXPECT_EQ(d.p99, 990.0);
  EXPECT_EQ(d.p999, 999.0);
  EXPECT_EQ(d.max, 1000.0);
}

TEST(DistributionOf, IsTheValueItselfForOneValue) {
  const auto d = rt::distributionOf(std::array{4.25});
  EXPECT_EQ(d.count, 1u);
  EXPECT_EQ(d.sd, 0.0);
  for (const double p : {d.mean, d.p50, d.p99, d.p999, d.max}) EXPECT_EQ(p, 4.25);
}

TEST(DistributionOf, IsEmptyForNoValues) {
  EXPECT_EQ(rt::distributionOf({}).count, 0u);
  EXPECT_EQ(rt::CycleStatistics().distributionNs().count, 0u);
}

TEST(Distribution, ScalesEverythingButTheCount) {
  const auto d = rt::scaled(rt::distributionOf(std::array{1e6, 3e6}), 1e-6);
  EXPECT_EQ(d.count, 2u);
  EXPECT_DOUBLE_EQ(d.mean, 2.0);
  EXPECT_DOUBLE_EQ(d.sd, 1.0);
  EXPECT_DOUBLE_EQ(d.p50, 1.0);
  EXPECT_DOUBLE_EQ(d.max, 3.0);
}

TEST(CycleStatistics, IsExactForSmallDurations) {
  const auto d = recorded({0, 1, 2, 126, 127})->distributionNs();
  EXPECT_EQ(d.p50, 2.0);
  EXPECT_EQ(d.p99, 127.0);
  EXPECT_EQ(d.max, 127.0);
}

TEST(CycleStatistics, CountsNegativeDurationsAsZero) {
  const auto d = recorded({-5})->distributionNs();
  EXPECT_EQ(d.count, 1u);
  EXPECT_EQ(d.max, 0.0);
}

TEST(CycleStatistics, KeepsTheExactMaximumOfDurationsBeyondItsRange) {
  constexpr std::int64_t kHour = 3'600'000'000'000;
  const auto d = recorded({kHour, kHour, kHour})->distributionNs();
  EXPECT_EQ(d.p50, static_cast<double>(kHour));
  EXPECT_EQ(d.max, static_cast<double>(kHour));
}

TEST(CycleStatistics, NeverReportsAPercentileAboveTheMaximum) {
  const auto d = recorded({1'000'001})->distributionNs();
  EXPECT_LE(d.p50, d.max);
  EXPECT_EQ(d.max, 1'000'001.0);
}

}  // namespace

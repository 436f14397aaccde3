#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "rt/statistics.h"

namespace {

/// Durations of every order of magnitude from 1 ns to a quarter of an hour.
rc::Gen<double> durationsNs() {
  return rc::gen::map(rc::gen::inRange(0, 27'000),
                      [](int milli_log) { return std::floor(std::exp(milli_log * 1e-3)); });
}

std::vector<double> someDurations() {
  return *rc::gen::resize(400, rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(
                                   rc::gen::resize(rc::kNominalSize, durationsNs()))));
}

RC_GTEST_PROP(StatisticsProperty, HistogramAgreesWithTheExactDistributionWithinOnePercent, ()) {
  const auto values = someDurations();
  const auto statistics = std::make_unique<rt::CycleStatistics>();
  for (const double ns : values) {
    statistics->record(rt::Nanoseconds(static_cast<std::int64_t>(ns)));
  }
  const auto counted = statistics->distributionNs();
  const auto exact = rt::distributionOf(values);

  const auto close = [](double a, double b, double relative) {
    return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b)) + 1e-9;
  };
  RC_ASSERT(counted.count == exact.count);
  RC_ASSERT(counted.max == exact.max);
  RC_ASSERT(close(counted.mean, exact.mean, 1e-9));
  RC_ASSERT(close(counted.sd, exact.sd, 1e-6));
  RC_ASSERT(close(counted.p50, exact.p50, 0.01));
  RC_ASSERT(close(counted.p99, exact.p99, 0.01));
  RC_ASSERT(close(counted.p999, exact.p999, 0.01));
}

RC_GTEST_PROP(StatisticsProperty, PercentilesCoverTheirShareAndAreValuesThatOccurred, ()) {
  const auto values = someDurations();
  const auto d = rt::distributionOf(values);
  const auto check = [&](double percentile, double share) {
    const auto below = [&](auto less) {
      return static_cast<double>(std::ranges::count_if(values, less));
    };
    const auto n = static_cast<double>(values.size());
    RC_ASSERT(std::ranges::find(values, percentile) != values.end());
    RC_ASSERT(below([&](double v) { return v <= percentile; }) >= share * n - 1e-6);
    RC_ASSERT(below([&](double v) { return v < percentile; }) < share * n);
  };
  check(d.p50, 0.5);
  check(d.p99, 0.99);
  check(d.p999, 0.999);
  RC_ASSERT(d.max == std::ranges::max(values));
}

}  // namespace

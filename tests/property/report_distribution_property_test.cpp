#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/tools/distribution.h"

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

RC_GTEST_PROP(DistributionProperty, PercentilesCoverTheirShareAndAreValuesThatOccurred, ()) {
  const auto values = someDurations();
  const auto d = appliance::distributionOf(values);
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

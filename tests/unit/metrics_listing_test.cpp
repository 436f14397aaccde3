#include "appliance/tools/metrics_listing.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using appliance::metricsListing;
using appliance::withMetrics;

TEST(MetricsListing, HasALineForEachMetric) {
  const auto listing = metricsListing(R"({"cpu.load": 0.25, "trigger.lateness": {"count": 40,
    "p50_us": 12.34, "p95_us": 56.78, "longest_us": 90.1, "longest_ever_us": 2345.6},
    "trigger.missed": 3})");
  ASSERT_TRUE(listing) << listing.error();
  EXPECT_EQ(*listing,
            "cpu.load          0.25\n"
            "trigger.lateness  40 times; us: half 12.3, 95 % 56.8, longest 90.1, ever 2345.6\n"
            "trigger.missed    3\n");
}

TEST(MetricsListing, IsEmptyWithoutMetrics) {
  EXPECT_EQ(metricsListing("{}"), "");
}

TEST(MetricsListing, TakesWhatAnotherVersionMayGive) {
  EXPECT_TRUE(
      metricsListing(R"({"a": "text", "b": null, "c": [1], "d": {"count": 1, "p50_us": "x"}})"));
  EXPECT_FALSE(metricsListing("no JSON"));
  EXPECT_FALSE(metricsListing("[]"));
}

TEST(MetricsListing, GoesIntoTheStatus) {
  EXPECT_EQ(withMetrics(R"({"mode":"live"})", R"({"a.b":1})"),
            R"({"mode":"live","metrics":{"a.b":1}})");
  EXPECT_EQ(withMetrics(R"({"mode":"live"})", ""), R"({"mode":"live"})");
}

}  // namespace

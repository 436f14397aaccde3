#include "appliance/metrics/metrics_registry.h"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "appliance/metrics/metrics_text.h"
#include "appliance/metrics/rate_meter.h"

namespace {

using namespace std::chrono_literals;
using appliance::find;
using appliance::MetricsGroup;
using appliance::MetricsRegistry;
using appliance::MetricsSnapshot;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> namesOf(const MetricsSnapshot& metrics) {
  std::vector<std::string> names;
  for (const auto& metric : metrics) names.push_back(metric.name);
  return names;
}

TEST(MetricsRegistry, ReadsEveryMetricAtTheMomentOfTheSnapshot) {
  MetricsRegistry registry;
  MetricsGroup group = registry.group("trigger");
  rt::Counter missed;
  rt::DurationWindow lateness;
  group.add("missed", missed);
  group.add("lateness", lateness);
  group.addLevel("temperature_c", [] { return 41.5; });
  missed.add(3);
  lateness.add(20us);

  const MetricsSnapshot metrics = registry.snapshot();
  EXPECT_THAT(namesOf(metrics),
              ElementsAre("trigger.lateness", "trigger.missed", "trigger.temperature_c"));
  EXPECT_EQ(std::get<std::uint64_t>(*find(metrics, "trigger.missed")), 3u);
  EXPECT_EQ(std::get<rt::DurationSummary>(*find(metrics, "trigger.lateness")).p95, 20us);
  EXPECT_EQ(std::get<double>(*find(metrics, "trigger.temperature_c")), 41.5);
  EXPECT_EQ(find(metrics, "trigger.misse"), nullptr);
  missed.add();
  EXPECT_EQ(std::get<std::uint64_t>(*find(registry.snapshot(), "trigger.missed")), 4u);
}

TEST(MetricsRegistry, AGroupTakesItsMetricsWithIt) {
  MetricsRegistry registry;
  MetricsGroup stays = registry.group("render");
  stays.addCount("pictures", [] { return 1u; });
  std::optional<MetricsGroup> goes = registry.group("camera01");
  goes->addCount("underruns", [] { return 2u; });
  goes.reset();
  EXPECT_THAT(namesOf(registry.snapshot()), ElementsAre("render.pictures"));
}

TEST(MetricsRegistry, AGroupMayBeMoved) {
  MetricsRegistry registry;
  MetricsGroup kept;
  {
    MetricsGroup made = registry.group("depth");
    made.addCount("pairs", [] { return 1u; });
    kept = std::move(made);
  }
  kept.addCount("dropped", [] { return 0u; });
  EXPECT_THAT(namesOf(registry.snapshot()), ElementsAre("depth.dropped", "depth.pairs"));
  kept = MetricsGroup();
  EXPECT_THAT(registry.snapshot(), IsEmpty());
}

TEST(MetricsText, IsOneJsonObject) {
  MetricsRegistry registry;
  MetricsGroup group = registry.group("a");
  rt::DurationWindow times;
  times.add(1500us);
  group.addCount("count", [] { return 7u; });
  group.add("times", times);
  EXPECT_EQ(nlohmann::json::parse(toJson(registry.snapshot())),
            nlohmann::json::parse(R"({"a.count": 7, "a.times": {"count": 1, "p50_us": 1500.0,
              "p95_us": 1500.0, "longest_us": 1500.0, "longest_ever_us": 1500.0}})"));
}

TEST(MetricsText, IsAnEmptyObjectWithoutMetrics) {
  EXPECT_EQ(toJson(MetricsSnapshot()), "{}");
}

class RateMeterTest : public testing::Test {
 protected:
  double look(rt::Nanoseconds at, std::uint64_t count) { return meter_.hz(kStart + at, count); }

 private:
  static constexpr rt::Timestamp kStart = rt::fromNs(5'000'000'000);
  appliance::RateMeter meter_;
};

TEST_F(RateMeterTest, KnowsNothingAtTheFirstLook) {
  EXPECT_EQ(look(0s, 1000), 0);
}

TEST_F(RateMeterTest, CountsOverASecondAtLeast) {
  look(0s, 100);
  EXPECT_EQ(look(500ms, 120), 0);
  EXPECT_DOUBLE_EQ(look(1s, 140), 40);
  EXPECT_DOUBLE_EQ(look(1500ms, 160), 40);
  EXPECT_DOUBLE_EQ(look(2s, 240), 100);
}

TEST_F(RateMeterTest, TakesLooksAsFarApartAsTheyCome) {
  look(0s, 0);
  EXPECT_DOUBLE_EQ(look(10s, 300), 30);
}

TEST_F(RateMeterTest, IsZeroWhenNothingHappensAnyMore) {
  look(0s, 0);
  look(1s, 40);
  EXPECT_DOUBLE_EQ(look(2s, 40), 0);
}

}  // namespace

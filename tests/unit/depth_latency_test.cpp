#include <chrono>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/depth/latency.h"

namespace {

using appliance::LampChange;
using appliance::LampSample;
using appliance::measureLatency;
using namespace std::chrono_literals;

constexpr rt::Timestamp kStart = rt::fromNs(1'000'000'000'000);

/// A lamp that changes after 0.2 to 0.8 s, for @p length.
std::vector<LampChange> lamp(rt::Nanoseconds length) {
  std::mt19937_64 random(3);
  std::vector<LampChange> changes;
  bool on = false;
  for (rt::Timestamp at = kStart; at < kStart + length;
       at += rt::Nanoseconds(200'000'000 + random() % 600'000'000)) {
    changes.push_back({at, on = !on});
  }
  return changes;
}

/// Pictures of it at 30 Hz, their stamps late by @p latency, with noise and a room around.
std::vector<LampSample> pictures(const std::vector<LampChange>& changes, rt::Nanoseconds latency) {
  std::mt19937_64 random(4);
  std::vector<LampSample> samples;
  for (rt::Timestamp t = kStart + 1ms; t < changes.back().at; t += 33'333us) {
    bool on = false;
    for (const LampChange& change : changes)
      if (change.at <= t) on = change.on;
    const auto noise = static_cast<double>(random() % 1000) * 1e-3;
    samples.push_back({t + latency, 90 + (on ? 60.0 : 0.0) + 4 * noise});
  }
  return samples;
}

TEST(MeasureLatency, FindsItFinerThanThePeriod) {
  const auto changes = lamp(30s);
  for (const rt::Nanoseconds latency : {rt::Nanoseconds(0), rt::Nanoseconds(12'300us),
                                        rt::Nanoseconds(40ms), rt::Nanoseconds(85ms)}) {
    const auto found = measureLatency(pictures(changes, latency), changes);
    ASSERT_TRUE(found) << found.error();
    EXPECT_LT(std::chrono::abs(found->latency - latency), 2ms) << latency.count();
    EXPECT_GT(found->correlation, 0.99);
    EXPECT_GT(found->changes, 40u);
  }
}

TEST(MeasureLatency, RefusesTooFewChanges) {
  const auto changes = lamp(5s);
  const auto found = measureLatency(pictures(changes, 40ms), changes);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error(), testing::HasSubstr("at least 20 times"));
  EXPECT_FALSE(measureLatency({}, {}));
}

TEST(MeasureLatency, RefusesPicturesThatDoNotSeeTheLamp) {
  const auto changes = lamp(30s);
  auto samples = pictures(changes, 40ms);
  std::mt19937_64 random(5);
  for (LampSample& sample : samples) sample.brightness = static_cast<double>(random() % 100);
  const auto blind = measureLatency(samples, changes);
  ASSERT_FALSE(blind);
  EXPECT_THAT(blind.error(), testing::HasSubstr("do not follow the lamp"));
  for (LampSample& sample : samples) sample.brightness = 100;
  EXPECT_FALSE(measureLatency(samples, changes));
}

}  // namespace

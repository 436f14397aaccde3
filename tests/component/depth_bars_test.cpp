// How good a depth sensor must be over minutes. Measured against the emulated one; the figures are
// printed.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/depth/depth_record.h"
#include "hal/openni/openni_sensor.h"
#include "tests/support/depth_feed.h"
#include "tests/support/depth_recordings.h"

namespace {

using hal::openni::OpenniSensor;
using test::DepthFeed;
using namespace std::chrono_literals;

std::unique_ptr<OpenniSensor> opened() {
  auto sensor = OpenniSensor::open({.drivers = KAGAMI_DEPTH_DRIVERS, .latency = 40ms});
  if (!sensor) {
    ADD_FAILURE() << sensor.error();
    return nullptr;
  }
  return std::move(*sensor);
}

TEST(DepthBars, ThirtyPicturesASecondWithoutAGapForFiveMinutes) {
  const DepthFeed feed(DepthFeed::sized(640, 480));
  const auto sensor = opened();
  ASSERT_TRUE(sensor);
  appliance::DepthRecord record;
  std::vector<rt::Nanoseconds> errors;
  while (record.length() < 5min) {
    const auto frame = sensor->waitFrame(20s);
    ASSERT_TRUE(frame) << sensor->status().message;
    record.onFrame(*frame);
    if (record.length() > 15s)  // the clock's fit has settled
      errors.push_back(std::chrono::abs(frame->exposure - feed.exposureOf(frame->number)));
  }
  std::ranges::sort(errors);
  const auto us = [](rt::Nanoseconds t) { return static_cast<double>(t.count()) * 1e-3; };
  std::printf(
      "%sexposure   off by %.0f us at the median, %.0f us at p99, %.0f us at most\n"
      "clock      %+.1f ppm, true +35.0\n",
      recordText(record).c_str(), us(errors[errors.size() / 2]),
      us(errors[errors.size() * 99 / 100]), us(errors.back()), sensor->status().drift_ppm);
  EXPECT_EQ(record.lost(), 0u);
  EXPECT_EQ(record.withoutColour(), 0u);
  EXPECT_TRUE(record.outages().empty());
  EXPECT_NEAR(record.rate_hz(), 30, 0.05);
  EXPECT_LT(us(errors[errors.size() / 2]), 2000);
}

TEST(DepthBars, IsBackWithinTwoSecondsTwentyTimes) {
  DepthFeed feed(DepthFeed::sized(640, 480));
  const auto sensor = opened();
  ASSERT_TRUE(sensor);
  ASSERT_TRUE(sensor->waitFrame(20s)) << sensor->status().message;
  std::vector<rt::Nanoseconds> returns;
  for (int time = 0; time < 20; ++time) {
    feed.plug(false);
    // From hardly noticed to long gone.
    const rt::Timestamp until = rt::now() + 100ms + time * 100ms;
    while (rt::now() < until) (void)sensor->waitFrame(10ms);
    const rt::Timestamp plugged = rt::now();
    feed.plug(true);
    const auto frame = [&] {
      for (;;) {
        auto next = sensor->waitFrame(20s);
        // One that was on its way before the plug was pulled does not count.
        if (!next || next->exposure > plugged) return next;
      }
    }();
    ASSERT_TRUE(frame) << "time " << time << ": " << sensor->status().message;
    returns.push_back(rt::now() - plugged);
  }
  std::ranges::sort(returns);
  std::printf("20 returns: %.2f s at the median, %.2f s at most\n",
              std::chrono::duration<double>(returns[10]).count(),
              std::chrono::duration<double>(returns.back()).count());
  EXPECT_LE(returns.back(), 2s);
  EXPECT_GE(sensor->status().returns, 19u) << "the first may be too short to be noticed";
}

}  // namespace

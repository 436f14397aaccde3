#include <chrono>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "hal/openni/clock_fit.h"

namespace {

using hal::openni::ClockFit;
using namespace std::chrono_literals;

constexpr rt::Nanoseconds kPeriod{33'333'333};
constexpr rt::Nanoseconds kLatency = 40ms;

/// A sensor whose clock is fast by @p ppm, and whose pictures arrive late by @p delay and more.
struct Sensor {
  double ppm = 0;
  rt::Timestamp power_on = rt::fromNs(5'000'000'000'000);
  [[nodiscard]] std::uint64_t stamp_us(rt::Timestamp exposure) const {
    const auto since_ns = static_cast<double>((exposure - power_on).count());
    return static_cast<std::uint64_t>(since_ns * (1 + ppm * 1e-6) / 1e3);
  }
};

/// Mostly punctual, now and then held up.
class Delays {
 public:
  rt::Nanoseconds next() {
    const double even = static_cast<double>(random_() >> 11U) * 0x1p-53;
    const bool held_up = random_() % 20 == 0;
    return rt::Nanoseconds(static_cast<std::int64_t>(-std::log(1 - even) * (held_up ? 2e7 : 8e5)));
  }

 private:
  std::mt19937_64 random_{7};
};

double errorAfter_us(const Sensor& sensor, rt::Nanoseconds length, double* drift_ppm = nullptr) {
  ClockFit fit;
  Delays delays;
  double worst_ns = 0;
  rt::Timestamp exposure = sensor.power_on + 2s;
  for (rt::Nanoseconds t{0}; t < length; t += kPeriod, exposure += kPeriod) {
    const std::uint64_t stamp_us = sensor.stamp_us(exposure);
    fit.add(stamp_us, exposure + kLatency + delays.next());
    if (t < length - 1s) continue;
    const auto error = fit.earliestArrival(stamp_us) - kLatency - exposure;
    worst_ns = std::max(worst_ns, std::abs(static_cast<double>(error.count())));
  }
  if (drift_ppm != nullptr) *drift_ppm = fit.drift_ppm();
  return worst_ns / 1e3;
}

TEST(ClockFit, FindsTheInstantBehindLateArrivals) {
  EXPECT_LT(errorAfter_us({.ppm = 0}, 3s), 1000);
  EXPECT_LT(errorAfter_us({.ppm = 0}, 60s), 500);
}

TEST(ClockFit, FollowsAClockThatRunsFastOrSlow) {
  for (const double ppm : {-100.0, -35.0, 35.0, 100.0}) {
    double found_ppm = 0;
    EXPECT_LT(errorAfter_us({.ppm = ppm}, 90s, &found_ppm), 500) << ppm;
    EXPECT_NEAR(found_ppm, ppm, 10);
  }
}

TEST(ClockFit, HoldsForHours) {
  EXPECT_LT(errorAfter_us({.ppm = 60}, 2h), 500);
}

TEST(ClockFit, BeginsAnewWithASensorThatRestarted) {
  ClockFit fit;
  const Sensor before{.ppm = 35};
  rt::Timestamp exposure = before.power_on + 20s;
  for (int i = 0; i < 900; ++i, exposure += kPeriod)
    fit.add(before.stamp_us(exposure), exposure + kLatency);
  const Sensor after{.ppm = 35, .power_on = exposure - 1s};  // its stamps run backwards
  for (int i = 0; i < 30; ++i, exposure += kPeriod)
    fit.add(after.stamp_us(exposure), exposure + kLatency);
  const auto found = fit.earliestArrival(after.stamp_us(exposure));
  EXPECT_LT(std::chrono::abs(found - kLatency - exposure), 1ms);
}

TEST(ClockFit, BeginsAnewWhenStampsLeapAhead) {
  ClockFit fit;
  const Sensor before;
  rt::Timestamp exposure = before.power_on + 20s;
  for (int i = 0; i < 900; ++i, exposure += kPeriod)
    fit.add(before.stamp_us(exposure), exposure + kLatency);
  const Sensor after{.power_on = before.power_on - 1h};
  for (int i = 0; i < 30; ++i, exposure += kPeriod)
    fit.add(after.stamp_us(exposure), exposure + kLatency);
  const auto found = fit.earliestArrival(after.stamp_us(exposure));
  EXPECT_LT(std::chrono::abs(found - kLatency - exposure), 1ms);
}

TEST(ClockFit, TakesASingleArrivalAtItsWord) {
  ClockFit fit;
  fit.add(123'456, rt::fromNs(9'000'000'000));
  EXPECT_EQ(fit.earliestArrival(123'456), rt::fromNs(9'000'000'000));
  EXPECT_EQ(fit.earliestArrival(133'456), rt::fromNs(9'010'000'000));
}

}  // namespace

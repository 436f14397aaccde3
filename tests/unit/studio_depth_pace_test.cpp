// When the studio's depth sensor takes which picture.
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "hal/emulated/studio/depth_pace.h"
#include "hal/emulated/studio/depth_sensor.h"

namespace {

using namespace std::chrono_literals;
using emulator::studio::DepthExposure;
using emulator::studio::nextDepthExposure;
using emulator::studio::PlayingMoment;

constexpr std::uint32_t kMoments = 40;
const rt::Timestamp kStart = rt::fromNs(1'000'000'000);
constexpr rt::Nanoseconds kPeriod(33'333'333);

/// What plays at @p now with a trigger every @p period, each @p late too late in turn.
PlayingMoment playingAt(rt::Timestamp now, rt::Nanoseconds period, rt::Nanoseconds late = 0ns) {
  const std::int64_t trigger = (now - kStart) / period;
  return {.moment = static_cast<std::uint32_t>(trigger) % kMoments,
          .moments = kMoments,
          .edge = kStart + trigger * period + (trigger % 2 == 0 ? 0ns : late),
          .period = trigger == 0 ? 0ns : period + (trigger % 2 == 0 ? -late : late)};
}

TEST(DepthPace, TakesAPictureInTheInstantItWasDrawnFor) {
  rt::Timestamp due = kStart + 137ms;
  std::uint32_t before = 0;
  for (int i = 0; i < 200; ++i) {
    const DepthExposure exposure = nextDepthExposure(due, playingAt(due, 25ms));
    const double second =
        std::fmod(std::chrono::duration<double>(exposure.at - kStart).count(), kMoments / 40.0);
    const double shown = exposure.picture / emulator::studio::kDepth_hz;
    EXPECT_LT(std::abs(std::remainder(second - shown, kMoments / 40.0)), 1e-5) << i;
    if (i > 0) {
      EXPECT_EQ(exposure.picture, (before + 1) % 30) << "none twice, none left out";
      EXPECT_LT(std::chrono::abs(exposure.at - (due - kPeriod) - kPeriod), 1us);
    }
    before = exposure.picture;
    due = exposure.at + kPeriod;
  }
}

TEST(DepthPace, KeepsItsRateWhereTriggersAreALittleLate) {
  rt::Timestamp due = kStart + 100ms;
  due = nextDepthExposure(due, playingAt(due, 25ms, 200us)).at + kPeriod;
  for (int i = 0; i < 200; ++i) {
    const DepthExposure exposure = nextDepthExposure(due, playingAt(due, 25ms, 200us));
    EXPECT_LT(std::chrono::abs(exposure.at - due), 1ms);
    due = exposure.at + kPeriod;
  }
}

TEST(DepthPace, ShowsTheNearestPictureAtOtherRates) {
  rt::Timestamp due = kStart + 1s;
  for (int i = 0; i < 100; ++i) {
    const PlayingMoment playing = playingAt(due, 100ms);  // slow motion
    const DepthExposure exposure = nextDepthExposure(due, playing);
    EXPECT_EQ(exposure.at, due) << "by its own clock";
    const double exact =
        0.75 * (playing.moment + std::chrono::duration<double>(due - playing.edge).count() / 0.1);
    EXPECT_LE(std::abs(std::remainder(exposure.picture - exact, 30.0)), 0.5001);
    due += kPeriod;
  }
}

TEST(DepthPace, StandsWhereNoTriggerComes) {
  const DepthExposure first = nextDepthExposure(kStart, {});
  EXPECT_EQ(first.at, kStart);
  EXPECT_EQ(first.picture, 0u);
  const PlayingMoment last = playingAt(kStart + 250ms, 25ms);
  const DepthExposure later = nextDepthExposure(kStart + 10s, last);
  EXPECT_EQ(later.at, kStart + 10s);
  EXPECT_EQ(later.picture, 7u) << "of moment 10";
}

TEST(DepthPace, EveryPictureLiesInAMoment) {
  for (std::uint32_t k = 0; k < 30; ++k) {
    const double moment = emulator::studio::momentOfDepth(k);
    EXPECT_LE(moment / 40, k / 30.0 + 1e-9);
    EXPECT_GT((moment + 1) / 40, k / 30.0 + 1e-9);
  }
  EXPECT_EQ(emulator::studio::depthPictures(kMoments), 30u);
}

}  // namespace

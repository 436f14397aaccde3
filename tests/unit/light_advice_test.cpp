#include "appliance/light/light_advice.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::adviseOnLight;
using appliance::lightLines;
using appliance::LightParameters;
using testing::ElementsAre;
using testing::HasSubstr;

/// Brightness of picture @p n of a lamp that goes from dark to full and back, summed up.
double brightness(const LightParameters& parameters, int n) {
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = n / parameters.rate_hz + (i + 0.5) / kSteps * parameters.exposure_us * 1e-6;
    sum += 1 + std::cos(2 * std::numbers::pi * 2 * parameters.mains_hz * t);
  }
  return sum / kSteps;
}

TEST(LightAdvice, KeepsTheFlickerThatSummedUpLightKeeps) {
  for (const double exposure_us : {100.0, 1000.0, 4000.0, 7000.0, 9900.0, 13000.0}) {
    const LightParameters parameters{.mains_hz = 50, .rate_hz = 37.3, .exposure_us = exposure_us};
    double least = 2;
    double most = 0;
    for (int n = 0; n < 400; ++n) {
      least = std::min(least, brightness(parameters, n));
      most = std::max(most, brightness(parameters, n));
    }
    EXPECT_NEAR(adviseOnLight(parameters).kept, (most - least) / 2, 0.01) << exposure_us << " us";
  }
}

TEST(LightAdvice, FindsTheBeatOfTheRateWithTheLamps) {
  EXPECT_NEAR(adviseOnLight({.mains_hz = 50, .rate_hz = 40}).beat_hz, 20, 1e-9);
  EXPECT_NEAR(adviseOnLight({.mains_hz = 50, .rate_hz = 60}).beat_hz, 20, 1e-9);
  EXPECT_NEAR(adviseOnLight({.mains_hz = 50, .rate_hz = 50}).beat_hz, 0, 1e-9);
  EXPECT_NEAR(adviseOnLight({.mains_hz = 60, .rate_hz = 40}).beat_hz, 0, 1e-9);
  EXPECT_NEAR(adviseOnLight({.mains_hz = 60, .rate_hz = 59.94}).beat_hz, 0.12, 1e-9);
  EXPECT_NEAR(adviseOnLight({.mains_hz = 50, .rate_hz = 240}).beat_hz, 100, 1e-9);
}

TEST(LightAdvice, NamesTheSteadyRatesAroundTheConfiguredRate) {
  EXPECT_THAT(adviseOnLight({.mains_hz = 50, .rate_hz = 40}).steady_rates,
              ElementsAre(50, 100.0 / 3));
  EXPECT_THAT(adviseOnLight({.mains_hz = 60, .rate_hz = 50}).steady_rates, ElementsAre(60, 40));
  EXPECT_THAT(adviseOnLight({.mains_hz = 50, .rate_hz = 50}).steady_rates, ElementsAre(50));
  EXPECT_THAT(adviseOnLight({.mains_hz = 50, .rate_hz = 240}).steady_rates, ElementsAre(100));
}

TEST(LightAdvice, EverySteadyRateHasNoBeat) {
  for (double rate_hz = 5; rate_hz < 300; rate_hz += 0.37) {
    for (const double steady : adviseOnLight({.rate_hz = rate_hz}).steady_rates) {
      EXPECT_NEAR(adviseOnLight({.rate_hz = steady}).beat_hz, 0, 1e-6) << rate_hz;
    }
  }
}

TEST(LightAdvice, WeighsTheEvenExposureAgainstItsBlur) {
  const auto advice = adviseOnLight({.exposure_us = 1000, .scale_px_m = 295});
  EXPECT_DOUBLE_EQ(advice.blur_mm, 20);
  EXPECT_DOUBLE_EQ(*advice.blur_px, 5.9);
  EXPECT_DOUBLE_EQ(advice.even_exposure_us, 10000);
  EXPECT_DOUBLE_EQ(advice.even_blur_mm, 200);
  EXPECT_FALSE(advice.even_fits);
}

std::vector<std::string> linesOf(const appliance::LightParameters& parameters) {
  std::vector<std::string> lines;
  for (const auto& line : lightLines(parameters)) lines.push_back(textOf(line));
  return lines;
}

TEST(LightAdvice, SpeaksInPlainWords) {
  EXPECT_THAT(
      linesOf({.scale_px_m = 295}),
      ElementsAre("exposure 1 ms: motion blur at 20 m/s is 20 mm (5.9 px)",
                  "lamps at 100 Hz: pictures keep 98 % of their flicker and beat at 20 Hz; no beat "
                  "at 50 Hz or 33.33 Hz",
                  "an exposure of 10 ms would keep none but blurs 200 mm: use lamps on direct "
                  "current or above 10 kHz, or display.flicker_compensation"));
  EXPECT_THAT(linesOf({.rate_hz = 50})[1], HasSubstr("sees the same part"));
  EXPECT_THAT(linesOf({.rate_hz = 40, .exposure_us = 20000})[1], HasSubstr("no flicker is left"));
}

}  // namespace

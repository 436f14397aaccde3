#include "appliance/light/light_advice.h"

#include <cmath>
#include <numbers>
#include <string>

namespace appliance {
namespace {

constexpr double kMainsWander_hz = 0.2;  // what European grids allow themselves every day
constexpr double kNoBeat_hz = 0.05;      // too slow to be seen
constexpr double kNothingKept = 0.01;

double blur_mm(double exposure_us) {
  return kFastestLimb_m_s * exposure_us * 1e-3;
}

/// There is at least one.
std::string ratesInWords(const std::vector<double>& rates) {
  return textOf(rates.size() > 1 ? phrase<Word::kLightEitherRate>(rates[0], rates[1])
                                 : phrase<Word::kLightRate>(rates[0]));
}

}  // namespace

LightAdvice adviseOnLight(const LightParameters& parameters) {
  LightAdvice advice;
  advice.lamp_hz = 2 * parameters.mains_hz;
  const double x = std::numbers::pi * advice.lamp_hz * parameters.exposure_us * 1e-6;
  advice.kept = std::abs(std::sin(x) / x);
  const double per_picture = advice.lamp_hz / parameters.rate_hz;
  advice.beat_hz = std::abs(per_picture - std::round(per_picture)) * parameters.rate_hz;
  advice.wander_hz = 2 * kMainsWander_hz;
  advice.blur_mm = blur_mm(parameters.exposure_us);
  if (parameters.scale_px_m > 0) advice.blur_px = advice.blur_mm * 1e-3 * parameters.scale_px_m;
  advice.even_exposure_us = 1e6 / advice.lamp_hz;
  advice.even_blur_mm = blur_mm(advice.even_exposure_us);
  advice.even_fits = advice.even_blur_mm <= kMostBlur_mm && parameters.rate_hz < advice.lamp_hz;
  // Whole lamp periods between two pictures.
  const double fewer = std::floor(per_picture + 1e-9);
  if (fewer >= 1) advice.steady_rates.push_back(advice.lamp_hz / fewer);
  if (advice.beat_hz > kNoBeat_hz) advice.steady_rates.push_back(advice.lamp_hz / (fewer + 1));
  return advice;
}

std::vector<Phrase> lightLines(const LightParameters& parameters) {
  const LightAdvice advice = adviseOnLight(parameters);
  const double exposure_ms = parameters.exposure_us * 1e-3;
  std::vector<Phrase> lines;
  lines.push_back(advice.blur_px
                      ? phrase<Word::kLightBlurPx>(exposure_ms, kFastestLimb_m_s, advice.blur_mm,
                                                   *advice.blur_px)
                      : phrase<Word::kLightBlur>(exposure_ms, kFastestLimb_m_s, advice.blur_mm));
  if (advice.kept < kNothingKept) {
    lines.push_back(phrase<Word::kLightSteady>(advice.lamp_hz));
    return lines;
  }
  const double kept_percent = 100 * advice.kept;
  lines.push_back(
      advice.beat_hz > kNoBeat_hz
          ? phrase<Word::kLightBeats>(advice.lamp_hz, kept_percent, advice.beat_hz,
                                      ratesInWords(advice.steady_rates))
          : phrase<Word::kLightWanders>(advice.lamp_hz, advice.wander_hz, kept_percent));
  const double even_ms = advice.even_exposure_us * 1e-3;
  lines.push_back(advice.even_fits ? phrase<Word::kLightEvenExposure>(even_ms)
                                   : phrase<Word::kLightEvenBlurs>(even_ms, advice.even_blur_mm));
  return lines;
}

}  // namespace appliance

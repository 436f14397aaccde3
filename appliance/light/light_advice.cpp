#include "appliance/light/light_advice.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace appliance {
namespace {

constexpr double kMainsWander_hz = 0.2;  // what European grids allow themselves every day
constexpr double kNoBeat_hz = 0.05;      // slower than anybody looks
constexpr double kNothingKept = 0.01;

std::string line(const char* format, auto... values) {
  std::array<char, 240> text{};
  (void)std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

double blur_mm(double exposure_us) {
  return kFastestLimb_m_s * exposure_us * 1e-3;
}

std::string ratesInWords(const std::vector<double>& rates) {
  std::string words;
  for (const double rate : rates) words += (words.empty() ? "" : " or ") + line("%.4g Hz", rate);
  return words;
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

std::vector<std::string> lightLines(const LightParameters& parameters) {
  const LightAdvice advice = adviseOnLight(parameters);
  std::string blur = line("exposure %.4g ms: motion blur at %.0f m/s is %.0f mm",
                          parameters.exposure_us * 1e-3, kFastestLimb_m_s, advice.blur_mm);
  if (advice.blur_px) blur += line(" (%.1f px)", *advice.blur_px);
  std::vector<std::string> lines{std::move(blur)};
  if (advice.kept < kNothingKept) {
    lines.push_back(line("lamps at %.4g Hz: the exposure takes whole periods, no flicker is left",
                         advice.lamp_hz));
    return lines;
  }
  const double kept_percent = 100 * advice.kept;
  if (advice.beat_hz > kNoBeat_hz) {
    lines.push_back(line("lamps at %.4g Hz: pictures keep %.0f %% of their flicker and beat at "
                         "%.3g Hz; no beat at ",
                         advice.lamp_hz, kept_percent, advice.beat_hz) +
                    ratesInWords(advice.steady_rates));
  } else {
    lines.push_back(
        line("lamps at %.4g Hz: every picture sees the same part of their flicker; the "
             "mains wanders, up to %.1f Hz of a beat with %.0f %% of it remain",
             advice.lamp_hz, advice.wander_hz, kept_percent));
  }
  lines.push_back(line("an exposure of %.4g ms would keep none", advice.even_exposure_us * 1e-3) +
                  (advice.even_fits
                       ? std::string(": use it")
                       : line(" but blurs %.0f mm: use lamps on direct current or above 10 kHz, or "
                              "display.flicker_compensation",
                              advice.even_blur_mm)));
  return lines;
}

}  // namespace appliance

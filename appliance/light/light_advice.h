#pragma once

#include <optional>
#include <vector>

#include "appliance/words/phrase.h"

namespace appliance {

/// What decides how much flicker a camera sees. Lamps on the mains flicker at twice its frequency,
/// by a tenth (old fluorescent tubes with good ballasts) to all (cheap LEDs) of their light. The
/// exposure and the rate decide how much of that the pictures keep.
struct LightParameters {
  double mains_hz = 50;
  double rate_hz = 40;  ///< triggers
  double exposure_us = 1000;
  /// Pixels per metre at the target; 0: not known.
  double scale_px_m = 0;
};

struct LightAdvice {
  double lamp_hz = 0;
  /// How much of the lamps' flicker a picture's brightness keeps, 0 to 1: the mean of a cosine of
  /// lamp_hz over the exposure, |sin x / x| with x = pi lamp_hz exposure.
  double kept = 0;
  /// Pictures wax and wane this often: the distance from lamp_hz to the nearest whole multiple of
  /// the trigger's rate. 0: every picture sees the same part of the flicker.
  double beat_hz = 0;
  /// The beat that remains although it is 0 by the numbers: the mains wanders by 0.2 Hz.
  double wander_hz = 0;
  double blur_mm = 0;             ///< at 20 m/s, a thrower's hand
  std::optional<double> blur_px;  ///< where the scale is known
  double even_exposure_us = 0;    ///< the shortest that keeps nothing: one lamp period
  double even_blur_mm = 0;        ///< the motion blur that it costs
  bool even_fits = false;         ///< it blurs no more than kMostBlur_mm and fits the period
  /// In Hz, near rate_hz, with a beat of 0; the faster first.
  std::vector<double> steady_rates;
};

/// More smears a hand into something that no coach can judge.
inline constexpr double kMostBlur_mm = 50;
inline constexpr double kFastestLimb_m_s = 20;

/// Pure. Everything in @p parameters but the scale is above 0.
[[nodiscard]] LightAdvice adviseOnLight(const LightParameters& parameters);

/// The advice for a person, one sentence each.
[[nodiscard]] std::vector<Phrase> lightLines(const LightParameters& parameters);

}  // namespace appliance

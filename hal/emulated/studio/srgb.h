#pragma once

#include <cmath>

namespace emulator::studio {

/// Encodes light (0..1) for a screen (0..1): IEC 61966-2-1.
[[nodiscard]] inline double srgb(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace emulator::studio

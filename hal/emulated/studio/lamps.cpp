#include "hal/emulated/studio/lamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hal/emulated/studio/hall_size.h"
#include "hal/emulated/studio/random.h"

namespace emulator::studio {

float Lamp::ripple(double seconds) const {
  if (!ripples) return 1;
  const double angle = 2 * std::numbers::pi * kRipple_hz * seconds + phase;
  return 1 + kRippleDepth * static_cast<float>(std::cos(angle));
}

std::vector<Lamp> hallLamps(std::uint64_t seed) {
  Random random(seed ^ 0x1a3b);
  std::vector<Lamp> lamps;
  constexpr std::array kColumns = {-8.4f, -4.2f, 0.0f, 4.2f, 8.4f};
  constexpr std::array kRows = {-6.4f, -2.2f, 2.2f, 6.0f};
  // The outer rows burn at half power, as the caretaker likes it.
  constexpr std::array kPower = {0.55f, 1.35f, 1.35f, 0.5f};
  for (std::size_t row = 0; row < kRows.size(); ++row) {
    for (std::size_t column = 0; column < kColumns.size(); ++column) {
      const float age = random.uniform(0.74f, 1.12f);
      const float warmth = random.uniform(-1, 1);
      if (row == 3 && column == 1) continue;  // dead
      Lamp lamp;
      lamp.centre = {kColumns[column], kRows[row], kLampHeight_m};
      lamp.half_u = {0.78f, 0, 0};
      lamp.half_v = {0, 0.16f, 0};
      lamp.normal = {0, 0, -1};
      lamp.radiance = Eigen::Vector3f(1 + 0.05f * warmth, 0.97f, 0.88f - 0.07f * warmth) *
                      (56 * age * kPower[row]);
      lamp.phase = static_cast<float>((row + column) % 3) * 2 * std::numbers::pi_v<float> / 3;
      lamps.push_back(lamp);
    }
  }
  std::ranges::stable_sort(lamps, {}, [](const Lamp& lamp) {
    return lamp.centre.head<2>().cwiseProduct(Eigen::Vector2f(1, 1.1f)).norm();
  });
  Lamp daylight;  // the window band of the right-hand wall
  daylight.centre = {kHallRight_m - 0.02f, 0, 5.0f};
  daylight.half_u = {0, 6.5f, 0};
  daylight.half_v = {0, 0, 0.65f};
  daylight.normal = {-1, 0, 0};
  daylight.radiance = {2.3f, 2.75f, 3.3f};
  daylight.ripples = false;
  lamps.push_back(daylight);
  return lamps;
}

}  // namespace emulator::studio

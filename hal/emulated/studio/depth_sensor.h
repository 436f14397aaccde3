#pragma once

#include <cstdint>

#include "hal/emulated/openni/ring.h"
#include "hal/emulated/studio/studio_rig.h"

namespace emulator::studio {

/// The studio's depth sensor: on a bracket over the middle of the arc, looking down at the athlete.
/// Its lens is that of the sensor that docs/depth.md names, as its driver gives it: depth and
/// colour from one point, without distortion.
[[nodiscard]] StudioCamera makeDepthSensor(std::uint64_t seed);

/// The same for the emulated driver.
[[nodiscard]] RgbdFormat depthSensorFormat();

/// Moments follow one another at 40 Hz and the sensor's pictures at 30 Hz; both begin with the
/// play. Picture k is of second k / kDepth_hz.
inline constexpr double kDepth_hz = 30;
/// Four moments take as long as three pictures.
[[nodiscard]] constexpr std::uint32_t depthPictures(std::uint32_t moments) {
  return moments / 4 * 3;
}
/// The moment whose turn it is to draw picture @p k: the last that begins no later.
[[nodiscard]] constexpr std::uint32_t momentOfDepth(std::uint32_t k) {
  return k / 3 * 4 + k % 3;
}

}  // namespace emulator::studio

#pragma once

#include <cstdint>
#include <vector>

#include "hal/emulated/studio/studio_rig.h"

namespace emulator::studio {

/// The empty hall as one camera's lens throws it on the sensor: row-major, top row first.
struct Backdrop {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float>
      rgb;  ///< light per pixel before vignetting, 3 per pixel, white in good light about 1
  std::vector<float> ripple;   ///< how far that swings at second 0, relative
  std::vector<float> depth_m;  ///< along the optical axis
};

}  // namespace emulator::studio

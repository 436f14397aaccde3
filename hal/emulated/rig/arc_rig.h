#pragma once

#include <cstdint>

#include "hal/emulated/rig/rig_file.h"

namespace emulator {

/// Cameras on a U-shaped arc around (0, 0, 1): 5.8 degrees apart (closer when more than 20
/// share its 110 degrees), about 4 m away and 1.2 m high, from left to right as seen from the
/// cameras' side, -y. Hung by human hands: places, aim, focal length and distortion scatter a
/// little, always the same way.
[[nodiscard]] RigModel makeArcRig(std::uint32_t cameras, SizePx size);

}  // namespace emulator

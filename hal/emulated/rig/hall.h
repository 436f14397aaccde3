#pragma once

#include <cstdint>
#include <vector>

#include "hal/emulated/rig/rig_file.h"

namespace emulator {

/// What @p camera sees of an empty training hall with a mannequin standing at the origin:
/// BayerRG8, linear light, rows without padding.
[[nodiscard]] std::vector<std::uint8_t> drawHall(const CameraModel& camera);

}  // namespace emulator

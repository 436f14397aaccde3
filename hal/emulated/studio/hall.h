#pragma once

#include <cstdint>
#include <vector>

#include "hal/emulated/studio/surfaces.h"

namespace emulator::studio {

/// The sports hall without people: shell, fixtures and equipment. The seed moves what people
/// leave standing about. Nothing stands nearer than 3 m to the origin.
[[nodiscard]] std::vector<Surface> buildHall(std::uint64_t seed);

}  // namespace emulator::studio

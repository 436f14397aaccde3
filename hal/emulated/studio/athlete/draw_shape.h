#pragma once

#include <cstdint>

#include "hal/emulated/studio/athlete/shape.h"

namespace emulator::studio {

/// A person drawn at random: height, build, sex, hair, skin and clothes as people in a sports
/// hall have them.
[[nodiscard]] BodyShape drawShape(std::uint64_t seed);

}  // namespace emulator::studio

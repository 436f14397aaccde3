#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/emulated/rig/registers.h"
#include "hal/emulated/studio/patch.h"

namespace emulator::studio {

/// The bytes of some moments, each with one patch per camera.
[[nodiscard]] std::vector<std::byte> writeMoments(std::span<const MomentPatches> moments);
/// Nothing when the bytes are no @p count moments of @p cameras cameras of @p size.
[[nodiscard]] std::optional<std::vector<MomentPatches>> readMoments(
    std::span<const std::byte> bytes, std::uint32_t count, std::uint32_t cameras, SizePx size);

}  // namespace emulator::studio

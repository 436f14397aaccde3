#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/emulated/rig/registers.h"

namespace emulator {

/// The pictures of one camera as its sensor would have seen them: BayerRG8 in linear light
/// (sRGB taken back), one after the other. Refuses pictures that are not of @p size, and more
/// than @p max_bytes in all.
[[nodiscard]] std::expected<std::vector<std::uint8_t>, std::string> readPictures(
    const std::filesystem::path& folder, const std::string& camera, SizePx size,
    std::size_t max_bytes);

}  // namespace emulator

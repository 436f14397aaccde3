#pragma once

#include <array>
#include <cstdint>

#include <opencv2/core.hpp>

#include "hal/emulated/studio/surfaces.h"

namespace emulator::studio {

/// The picture of each cover: RGBA, sRGB curve, lower row first. Only kNet's alpha is not 255.
using CoverPictures = std::array<cv::Mat, kCoverCount>;
[[nodiscard]] CoverPictures drawCovers(std::uint64_t seed);

/// Fine grain of floor strips, to be repeated every 1.6 m: RGBA of which 128 is neutral.
[[nodiscard]] cv::Mat drawFloorGrain(std::uint64_t seed);

}  // namespace emulator::studio

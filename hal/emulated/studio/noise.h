#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace emulator::studio {

/// Smooth noise of several octaves in [0, 1], mean near 0.5: the coarsest @p coarse_px wide, each
/// further one half as wide and strong. Tiles in both directions. CV_32F.
[[nodiscard]] cv::Mat fractalNoise(cv::Size size, int coarse_px, int octaves, std::uint64_t seed);

/// One random value per pixel in [-1, 1]. CV_32F.
[[nodiscard]] cv::Mat whiteNoise(cv::Size size, std::uint64_t seed);

}  // namespace emulator::studio

#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace emulator::studio {

/// The whole floor from above, +y upwards: strip parquet, the lines of several games in their
/// colours, scuffs, tape and wear. RGB, sRGB curve.
[[nodiscard]] cv::Mat drawFloor(std::uint64_t seed);

}  // namespace emulator::studio

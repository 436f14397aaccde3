#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "hal/emulated/studio/play.h"

namespace emulator::studio {

/// One camera's sensor at a moment: BayerRG8, linear.
[[nodiscard]] cv::Mat rawPicture(const Play& play, std::uint32_t camera, std::uint32_t moment);
/// The same for people: in colour, with the camera's gains and the sRGB curve. BGR.
[[nodiscard]] cv::Mat shownPicture(const Play& play, std::uint32_t camera, std::uint32_t moment);

}  // namespace emulator::studio

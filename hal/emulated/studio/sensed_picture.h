#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include <opencv2/core.hpp>

#include "hal/emulated/studio/play.h"

namespace emulator::studio {

/// What the depth sensor delivers of one picture, for people: distances in false colours (near red,
/// far blue, black where nothing was measured) beside the registered colour picture. BGR.
/// @p play  has a depth sensor, and the moment of @p picture is drawn.
[[nodiscard]] cv::Mat sensedPicture(const Play& play, std::uint32_t picture);

}  // namespace emulator::studio

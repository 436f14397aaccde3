#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include <opencv2/core.hpp>

#include "hal/emulated/studio/studio_options.h"

namespace emulator::studio {

/// What is how far away from one camera at a second of the play: metres along the optical axis,
/// seen through its lens, without noise. CV_32F. For tests and evaluation.
[[nodiscard]] std::expected<cv::Mat, std::string> renderDepth(const StudioOptions& options,
                                                              std::uint32_t camera, double second);
/// Near red, far blue. BGR.
[[nodiscard]] cv::Mat colourDepth(const cv::Mat& depth_m);

}  // namespace emulator::studio

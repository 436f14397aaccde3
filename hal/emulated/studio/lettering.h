#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace emulator::studio {

/// Writes ASCII text into an RGB picture; capitals are @p height_px tall and stand on
/// @p baseline_left. Where the machine lacks the usual font, OpenCV's plain one does.
/// Returns the width written.
int letter(cv::Mat& picture, const std::string& text, cv::Point baseline_left, int height_px,
           const cv::Scalar& rgb);
/// The same, centred on @p middle_x.
void letterCentred(cv::Mat& picture, const std::string& text, int middle_x, int baseline,
                   int height_px, const cv::Scalar& rgb);

}  // namespace emulator::studio

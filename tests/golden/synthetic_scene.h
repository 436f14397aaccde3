#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/pixel_format.h"

/// A picture in linear light that tests every part of the warp: smooth shading that reaches into
/// the shadows, a texture of waves in all directions, and edges.
cv::Mat3b syntheticScene(cv::Size size);

/// What a camera with that colour filter reads from it.
std::vector<std::byte> mosaicOf(const cv::Mat3b& rgb, hal::PixelFormat format);

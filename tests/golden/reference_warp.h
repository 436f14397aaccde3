#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "hal/scene.h"

/// The same picture as the renderer's by another way: every pixel's backward map in double,
/// bilinear by cv::remap on floats, the colour model pixel by pixel in double, the soft edge, and
/// the sRGB formula itself.
struct ReferencePicture {
  cv::Mat3f rgb;     ///< encoded, 0 to 255
  cv::Mat1b inside;  ///< 255 where the lookup's whole footprint lies in the source
  cv::Mat1b border;  ///< 255 where nothing of the source may show
};

/// @p linear_rgb: the demosaiced source, 8 bits per channel.
ReferencePicture referenceWarp(const hal::WarpPlan& plan, const cv::Mat3b& linear_rgb,
                               cv::Size display);

struct ReferenceLayer {
  const hal::ViewLayer& layer;
  const cv::Mat3b& linear_rgb;
};

/// Layers over the surround, in float and linear light, each with its rectangle, opacity and the
/// part of a pixel that its camera sees; then the sRGB formula itself. 0 to 255.
cv::Mat3f referenceScene(std::span<const ReferenceLayer> layers, cv::Size display);

/// In dB over the pixels of @p mask, all channels.
double psnr(const cv::Mat3f& a, const cv::Mat3f& b, const cv::Mat1b& mask);

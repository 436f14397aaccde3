#include "ui-kms/cpu_demosaic.h"

#include <cassert>

#include <opencv2/imgproc.hpp>

namespace ui {
namespace {

/// GenICam names a mosaic by the row's first two pixels; OpenCV by the second row's second and
/// third, so the letters never agree: what arrives as RGGB is OpenCV's "BG".
int openCvCode(hal::PixelFormat format) {
  switch (format) {
    case hal::PixelFormat::kBayerRG8:
      return cv::COLOR_BayerBG2RGBA;
    case hal::PixelFormat::kBayerGB8:
      return cv::COLOR_BayerGR2RGBA;
    case hal::PixelFormat::kBayerGR8:
      return cv::COLOR_BayerGB2RGBA;
    case hal::PixelFormat::kBayerBG8:
      return cv::COLOR_BayerRG2RGBA;
    case hal::PixelFormat::kMono8:
      return cv::COLOR_GRAY2RGBA;
  }
  return cv::COLOR_GRAY2RGBA;
}

}  // namespace

void demosaicOnCpu(const hal::SourceImage& source, std::span<std::byte> rgba) {
  assert(rgba.size() == std::size_t{4} * source.width_px * source.height_px);
  const cv::Size size(static_cast<int>(source.width_px), static_cast<int>(source.height_px));
  // OpenCV has no Mat of constant pixels; cvtColor only reads its source.
  const cv::Mat mosaic(size, CV_8UC1, const_cast<std::byte*>(source.pixels));
  cv::Mat colour(size, CV_8UC4, rgba.data());
  cv::cvtColor(mosaic, colour, openCvCode(source.format));
  assert(colour.data == reinterpret_cast<uchar*>(rgba.data()));
}

}  // namespace ui

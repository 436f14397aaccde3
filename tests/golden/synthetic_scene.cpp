#include "tests/golden/synthetic_scene.h"

#include <cmath>

cv::Mat3b syntheticScene(cv::Size size) {
  cv::Mat3b scene(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double across = static_cast<double>(x) / size.width;
      const double down = static_cast<double>(y) / size.height;
      const double waves = std::sin(x * 0.21 + y * 0.08) * std::sin(y * 0.17 - x * 0.05);
      const bool tile = (x / 96 + y / 96) % 2 == 0;
      const double light = across * across * (tile ? 1.0 : 0.6);
      scene(y, x) = cv::Vec3b(
          cv::saturate_cast<uchar>(255 * light * (0.8 + 0.2 * waves)),
          cv::saturate_cast<uchar>(255 * light * (0.35 + 0.6 * down)),
          cv::saturate_cast<uchar>(255 * (0.1 + 0.8 * light * (1 - down)) * (0.9 - 0.1 * waves)));
    }
  }
  return scene;
}

std::vector<std::byte> mosaicOf(const cv::Mat3b& rgb, hal::PixelFormat format) {
  using enum hal::PixelFormat;
  const int red_x = format == kBayerGR8 || format == kBayerBG8 ? 1 : 0;
  const int red_y = format == kBayerGB8 || format == kBayerBG8 ? 1 : 0;
  std::vector<std::byte> mosaic;
  mosaic.reserve(rgb.total());
  for (int y = 0; y < rgb.rows; ++y) {
    for (int x = 0; x < rgb.cols; ++x) {
      const bool on_red_row = y % 2 == red_y;
      const bool on_red_column = x % 2 == red_x;
      int channel = 1;
      if (format != kMono8 && on_red_row && on_red_column) channel = 0;
      if (format != kMono8 && !on_red_row && !on_red_column) channel = 2;
      mosaic.push_back(static_cast<std::byte>(rgb(y, x)[channel]));
    }
  }
  return mosaic;
}

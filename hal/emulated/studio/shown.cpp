#include "hal/emulated/studio/shown.h"

#include <array>

#include <opencv2/imgproc.hpp>

#include "hal/emulated/studio/sensor_view.h"
#include "hal/emulated/studio/srgb.h"

namespace emulator::studio {

cv::Mat rawPicture(const Play& play, std::uint32_t camera, std::uint32_t moment) {
  const SizePx size = play.rig().cameras[camera].model.image_size;
  std::vector<std::uint8_t> pixels = play.background(camera, moment % kVariants);
  play.overlay(moment, camera).putInto(pixels, 0);
  return cv::Mat(static_cast<int>(size.height), static_cast<int>(size.width), CV_8U, pixels.data())
      .clone();
}

cv::Mat shownPicture(const Play& play, std::uint32_t camera, std::uint32_t moment) {
  cv::Mat bgr;
  cv::cvtColor(rawPicture(play, camera, moment), bgr,
               cv::COLOR_BayerBG2BGR);  // OpenCV's name of BayerRG
  const auto& gains = play.rig().cameras[camera].model.gain_rgb;
  cv::Mat curves(1, 256, CV_8UC3);
  for (int v = 0; v < 256; ++v) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double light = v / 255.0 * gains[2 - c];
      curves.at<cv::Vec3b>(0, v)[static_cast<int>(c)] =
          cv::saturate_cast<std::uint8_t>(255 * srgb(light));
    }
  }
  cv::LUT(bgr, curves, bgr);
  return bgr;
}

}  // namespace emulator::studio

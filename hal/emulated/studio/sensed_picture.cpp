#include "hal/emulated/studio/sensed_picture.h"

#include <vector>

#include <opencv2/imgproc.hpp>

#include "hal/emulated/openni/sensor_model.h"
#include "hal/emulated/studio/depth_sensor.h"
#include "hal/emulated/studio/rgbd_track.h"

namespace emulator::studio {

cv::Mat sensedPicture(const Play& play, std::uint32_t picture) {
  constexpr double kNear_mm = 1500;
  constexpr double kFar_mm = 8000;
  const RgbdFormat format = depthSensorFormat();
  const auto height = static_cast<int>(format.height_px);
  const auto width = static_cast<int>(format.width_px);
  std::vector<float> depth_m(format.pixels());
  std::vector<std::uint8_t> perfect_rgb(3 * format.pixels());
  play.rgbd()->view()->drawEmpty({depth_m, perfect_rgb});
  play.rgbd()->patch(momentOfDepth(picture)).putInto({depth_m, perfect_rgb});

  SensorModel sensor(SensorTraits{}, format);
  std::vector<std::uint16_t> depth_mm(format.pixels());
  std::vector<std::uint8_t> rgb(perfect_rgb.size());
  sensor.senseDepth(depth_m, perfect_rgb, picture, depth_mm);
  sensor.senseColour(perfect_rgb, picture, rgb);

  const cv::Mat measured(height, width, CV_16U, depth_mm.data());
  cv::Mat nearness;
  measured.convertTo(nearness, CV_32F);
  cv::divide(1.0, nearness, nearness);
  const double scale = 255 / (1 / kNear_mm - 1 / kFar_mm);
  nearness.convertTo(nearness, CV_8U, scale, -scale / kFar_mm);
  cv::Mat both(height, 2 * width, CV_8UC3);
  cv::Mat distances = both.colRange(0, width);
  cv::applyColorMap(nearness, distances, cv::COLORMAP_TURBO);
  distances.setTo(cv::Scalar::all(0), measured == 0);
  cv::cvtColor(cv::Mat(height, width, CV_8UC3, rgb.data()), both.colRange(width, 2 * width),
               cv::COLOR_RGB2BGR);
  return both;
}

}  // namespace emulator::studio

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/emulated/rig/stamp_code.h"

namespace test {

/// A still that a run kept, with what the daemon says it shows.
struct ShownPicture {
  std::string name;
  std::string mode;
  std::uint32_t camera = 0;
  std::uint64_t trigger = 0;
  cv::Matx33d H_camera_display;
  cv::Matx33d camera_matrix;
  cv::Vec<double, 5> distortion;
  cv::Mat picture;  // as on the screen, BGR

  /// Where a pixel of the camera's own picture is on the screen.
  [[nodiscard]] cv::Point2d toDisplay(cv::Point2d source_px) const;

  /// The stamp that the emulated camera painted, read from the screen's pixels. The emulator's
  /// frame is as large as its sensor: @p source_size.
  [[nodiscard]] std::optional<emulator::Stamp> readStamp(cv::Size source_size) const;
};

/// The stills that a recorder left in @p folder.
[[nodiscard]] std::vector<ShownPicture> readStills(const std::filesystem::path& folder);

}  // namespace test

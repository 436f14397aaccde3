#pragma once

#include <array>
#include <expected>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/emulated/rig/registers.h"

namespace emulator {

/// One camera of rig.toml: x_cam = rotation x_rig + translation_m; camera axes x right, y down,
/// z forward; integer pixel coordinates at pixel centres; distortion in OpenCV's order.
struct CameraModel {
  std::string name;
  SizePx image_size;
  std::array<double, 2> focal_px{};
  std::array<double, 2> centre_px{};
  std::array<double, 5> distortion{};
  std::array<std::array<double, 3>, 3> rotation{};
  std::array<double, 3> translation_m{};
  std::array<double, 3> gain_rgb{1, 1, 1};  ///< colour gains, linear light
};

/// What stands where: the rig frame is metric, +Z up, its origin on the floor.
struct RigModel {
  std::string name;
  std::array<double, 3> target_m{};
  std::vector<CameraModel> cameras;
};

[[nodiscard]] std::string toToml(const RigModel& rig);
[[nodiscard]] std::expected<void, std::string> writeRigFile(const std::filesystem::path& path,
                                                            const RigModel& rig);

/// The names and image sizes of a rig.toml: all that a scene needs.
[[nodiscard]] std::expected<RigModel, std::string> readRigFile(const std::filesystem::path& path);
/// The same from memory; @p name stands in messages in place of a path.
[[nodiscard]] std::expected<RigModel, std::string> parseRigFile(std::string_view text,
                                                                const std::filesystem::path& name);

}  // namespace emulator

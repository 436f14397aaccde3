#pragma once

#include <expected>
#include <filesystem>
#include <string>
#include <string_view>

#include "hal/emulated/rig/rig_file.h"

namespace emulator {

/// The cameras of a Qualisys calibration (.qca.txt), as Pose2Sim's examples carry it:
/// X_cam = diag(1, -1, -1) R (X - C), millimetres; intrinsics in 1/64 pixel.
[[nodiscard]] std::expected<RigModel, std::string> parseQualisys(std::string_view xml);

/// Makes a camera fit videos of another size than it was calibrated for: the picture was
/// scaled as a whole and centred between bars.
[[nodiscard]] CameraModel letterboxed(const CameraModel& camera, SizePx video);

/// Makes a scene folder of Pose2Sim's single-person example: rig.toml and the videos.
/// The target is the person's pelvis in the middle of that recording; returns the rig.
[[nodiscard]] std::expected<RigModel, std::string> convertPose2sim(
    const std::filesystem::path& source, const std::filesystem::path& destination);

}  // namespace emulator

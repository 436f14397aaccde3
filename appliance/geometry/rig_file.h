#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "appliance/geometry/rig.h"

namespace appliance {

/// Reads a rig file of format 1 or 2, described in docs/rig-file.md. Unknown keys and newer formats
/// are ignored, with a line each in Rig::warnings.
///
/// RT      Not RT safe.
/// Errors  One line that says file, line, camera, what is wrong and what to do. A rig that is
///         returned is sound: finite, rotations proper, the target in front of every camera.
/// @p usual_format: of the cameras for which the file states none.
[[nodiscard]] std::expected<Rig, std::string> loadRig(
    const std::string& path, hal::PixelFormat usual_format = hal::PixelFormat::kBayerRG8);

/// The same from memory; @p name stands in messages in place of a path.
[[nodiscard]] std::expected<Rig, std::string> parseRig(
    std::string_view text, std::string name,
    hal::PixelFormat usual_format = hal::PixelFormat::kBayerRG8);

}  // namespace appliance

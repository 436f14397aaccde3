#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "hal/depth_sensor.h"

namespace hal::openni {

/// A folder recording's sensor.toml.
struct FolderSensorFile {
  std::string name;  ///< printable; empty: not given
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  DepthLens lens;
  double rate_hz = 30;
};

/// Sizes are 1 to 8192 px, focal lengths positive, the rate 0.1 to 1000 Hz.
/// Errors  One line for a person, which begins with @p where.
[[nodiscard]] std::expected<FolderSensorFile, std::string> parseFolderSensor(
    std::string_view text, const std::string& where);

/// A folder recording's stamps.csv: microseconds by picture numbers.
/// Errors  As above, with the line's number.
[[nodiscard]] std::expected<std::map<std::uint64_t, std::uint64_t>, std::string> parseFolderStamps(
    std::string_view text, const std::string& where);

/// A number as files of a recording are named and stamped with: digits alone.
[[nodiscard]] std::optional<std::uint64_t> folderNumber(std::string_view text);

}  // namespace hal::openni

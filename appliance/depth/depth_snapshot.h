#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "appliance/depth/depth_board.h"
#include "rt/clock.h"

namespace appliance {

/// A snapshot that was asked for.
struct DepthSnapshotOrder {
  std::filesystem::path folder;  ///< made by the snapshot
  std::string sensor;            ///< what the sensor calls itself
  std::uint32_t pairs = 1;
  rt::Nanoseconds patience = std::chrono::seconds(3);  ///< for the next pair
};

/// Numbers for files of pictures: the sensor's own, and rising even if the sensor begins to count
/// again, as one does that was unplugged. Pure.
class RisingNumbers {
 public:
  [[nodiscard]] std::uint64_t of(std::uint64_t sensor_number);

 private:
  std::optional<std::uint64_t> sensors_last_;
  std::uint64_t last_ = 0;
};

/// The pins of a snapshot's reader.
inline constexpr std::uint32_t kSnapshotPins = DepthBoard::kKept;

/// Writes the newest pairs that the board keeps, and as many more as come, as a folder that plays
/// as a sensor. A snapshot that does not get whole leaves no folder.
///
/// Threads  One: a job's. @p reader has a budget of kSnapshotPins.
/// Errors   One line: no pair came, the pictures' size changed, the folder cannot be written. Asked
///          to stop it returns a line that says how far it got.
[[nodiscard]] std::expected<std::string, std::string> writeDepthSnapshot(
    DepthReader& reader, const DepthSnapshotOrder& order,
    const std::function<void(double)>& progress, const std::stop_token& stop);

/// A folder for a snapshot that is made now: named by the date, and not there yet.
[[nodiscard]] std::filesystem::path snapshotFolder(const std::filesystem::path& parent);

}  // namespace appliance

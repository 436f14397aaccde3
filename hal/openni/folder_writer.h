#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <fstream>
#include <string>

#include "hal/depth_sensor.h"
#include "rt/clock.h"

namespace hal::openni {

enum class ColourFile : std::uint8_t { kPng, kJpeg };

/// Writes a sensor's pictures as a folder: folder_recording.h says what it holds.
///
/// Threads  One caller.
/// Errors   One line for a person: the folder holds something already, the disk is full.
class FolderWriter {
 public:
  FolderWriter(std::filesystem::path folder, ColourFile colour)
      : folder_(std::move(folder)), colour_(colour) {}

  /// @p name: the sensor's. The first frame makes the folder.
  [[nodiscard]] std::expected<void, std::string> write(const DepthFrame& frame,
                                                       const std::string& name);
  [[nodiscard]] std::uint64_t written() const { return written_; }

 private:
  [[nodiscard]] std::expected<void, std::string> begin(const DepthFrame& frame,
                                                       const std::string& name);

  std::filesystem::path folder_;
  ColourFile colour_;
  std::ofstream stamps_;
  rt::Timestamp first_;
  std::uint64_t written_ = 0;
};

}  // namespace hal::openni

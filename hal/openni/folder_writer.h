#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <string>
#include <utility>

#include "hal/depth_recorder.h"
#include "rt/clock.h"

namespace hal::openni {

enum class ColourFile : std::uint8_t { kPng, kJpeg };

/// Writes a sensor's pictures as a folder: folder_recording.h says what it holds. The first frame
/// makes the folder.
class FolderWriter final : public DepthRecorder {
 public:
  FolderWriter(std::filesystem::path folder, ColourFile colour)
      : folder_(std::move(folder)), colour_(colour) {}

  [[nodiscard]] std::expected<void, std::string> write(const DepthFrame& frame,
                                                       const std::string& sensor) override;
  [[nodiscard]] std::uint64_t written() const { return written_; }

 private:
  [[nodiscard]] std::expected<void, std::string> begin(const DepthFrame& frame,
                                                       const std::string& sensor);
  [[nodiscard]] std::expected<void, std::string> writeColour(const DepthFrame& frame,
                                                             const std::string& stem);

  std::filesystem::path folder_;
  ColourFile colour_;
  rt::Timestamp first_;
  std::uint64_t written_ = 0;
};

}  // namespace hal::openni

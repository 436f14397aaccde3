#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/depth_sensor.h"
#include "hal/openni/folder_text.h"

namespace hal::openni {

/// A depth sensor's recording that any program can read: a folder with
///
///   sensor.toml           format, name, size_px, focal_px, centre_px, rate_hz
///   depth/000001.png      16 bit grey, millimetres, 0: nothing measured
///   colour/000001.png     or .jpg: the same view in the same size; may be missing
///   stamps.csv            number,stamp_us: when each was taken; without it they come evenly
///
/// File names are the sensor's picture numbers: a number that is missing is a lost picture.
///
/// Threads  One caller.
/// Errors   One line for a person, with the file.
class FolderRecording {
 public:
  struct Entry {
    std::uint64_t number = 0;
    std::uint64_t stamp_us = 0;
    std::filesystem::path depth;
    std::filesystem::path colour;  ///< empty: none
  };
  struct Pictures {
    std::vector<std::uint16_t> depth_mm;
    std::vector<std::uint8_t> colour_rgb;  ///< empty: none
    std::string remark;                    ///< why there is no colour although there is a file
  };

  [[nodiscard]] static std::expected<FolderRecording, std::string> open(
      const std::filesystem::path& folder);

  [[nodiscard]] const std::string& name() const { return sensor_.name; }
  [[nodiscard]] std::uint32_t width_px() const { return sensor_.width_px; }
  [[nodiscard]] std::uint32_t height_px() const { return sensor_.height_px; }
  [[nodiscard]] const DepthLens& lens() const { return sensor_.lens; }
  [[nodiscard]] bool colour() const { return colour_; }
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }  ///< not empty

  [[nodiscard]] std::expected<Pictures, std::string> read(const Entry& entry) const;

 private:
  FolderRecording() = default;
  [[nodiscard]] std::expected<void, std::string> readSensor(const std::filesystem::path& file);
  [[nodiscard]] std::expected<void, std::string> findPictures(const std::filesystem::path& folder);
  [[nodiscard]] std::expected<void, std::string> readStamps(const std::filesystem::path& file);

  FolderSensorFile sensor_;
  bool colour_ = false;
  std::vector<Entry> entries_;
};

}  // namespace hal::openni

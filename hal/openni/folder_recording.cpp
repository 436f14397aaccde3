#include "hal/openni/folder_recording.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <system_error>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/openni/folder_text.h"
#include "rt/printable.h"

namespace hal::openni {
namespace {

namespace fs = std::filesystem;

/// Nothing where it cannot be read.
std::optional<std::string> contentOf(const fs::path& file) {
  std::error_code failed;
  std::ifstream in(file, std::ios::binary);
  if (!in || !fs::is_regular_file(file, failed)) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

/// The pictures of a folder by their numbers; other files are none of our business.
std::map<std::uint64_t, fs::path> numbered(const fs::path& folder) {
  std::map<std::uint64_t, fs::path> found;
  std::error_code failed;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, failed)) {
    const std::string kind = file.path().extension();
    if (kind != ".png" && kind != ".jpg" && kind != ".jpeg") continue;
    if (const auto number = folderNumber(file.path().stem().string()))
      found.emplace(*number, file.path());
  }
  return found;
}

/// As OpenCV reads it; empty where it cannot, whatever is in the file.
cv::Mat imageOf(const fs::path& file, int flags) {
  try {
    return cv::imread(file.string(), flags);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

std::expected<FolderRecording, std::string> FolderRecording::open(const fs::path& folder) {
  std::error_code failed;
  if (!fs::is_directory(folder, failed))
    return std::unexpected(folder.string() +
                           ": there is no such folder: correct "
                           "depth_sensor.source");
  FolderRecording recording;
  if (auto read = recording.readSensor(folder / "sensor.toml"); !read)
    return std::unexpected(read.error());
  if (auto found = recording.findPictures(folder); !found) return std::unexpected(found.error());
  const fs::path stamps = folder / "stamps.csv";
  if (fs::exists(stamps, failed)) {
    if (auto read = recording.readStamps(stamps); !read) return std::unexpected(read.error());
  }
  return recording;
}

std::expected<void, std::string> FolderRecording::readSensor(const fs::path& file) {
  const auto text = contentOf(file);
  if (!text) return std::unexpected(file.string() + ": a recording's folder holds a sensor.toml");
  auto sensor = parseFolderSensor(*text, file.string());
  if (!sensor) return std::unexpected(sensor.error());
  sensor_ = std::move(*sensor);
  if (sensor_.name.empty()) sensor_.name = rt::printable(file.parent_path().filename().string());
  return {};
}

std::expected<void, std::string> FolderRecording::findPictures(const fs::path& folder) {
  const auto colours = numbered(folder / "colour");
  colour_ = !colours.empty();
  for (const auto& [number, depth] : numbered(folder / "depth")) {
    const auto colour = colours.find(number);
    const auto order = static_cast<double>(entries_.empty() ? 0 : number - entries_[0].number);
    entries_.push_back(
        {.number = number,
         .stamp_us = static_cast<std::uint64_t>(std::llround(order * 1e6 / sensor_.rate_hz)),
         .depth = depth,
         .colour = colour == colours.end() ? fs::path() : colour->second});
  }
  if (!entries_.empty()) return {};
  return std::unexpected((folder / "depth").string() +
                         ": holds no picture: they are named by their numbers, 000001.png");
}

std::expected<void, std::string> FolderRecording::readStamps(const fs::path& file) {
  const auto text = contentOf(file);
  if (!text) return std::unexpected(file.string() + ": cannot be read: check its permissions");
  const auto stamps = parseFolderStamps(*text, file.string());
  if (!stamps) return std::unexpected(stamps.error());
  for (Entry& entry : entries_) {
    const auto stamp = stamps->find(entry.number);
    if (stamp == stamps->end()) {
      return std::unexpected(file.string() + ": has no line for picture " +
                             std::to_string(entry.number) + ": add it, or remove the file");
    }
    entry.stamp_us = stamp->second;
  }
  return {};
}

std::expected<FolderRecording::Pictures, std::string> FolderRecording::read(
    const Entry& entry) const {
  const auto fits = [this](const cv::Mat& image) {
    return image.cols == static_cast<int>(sensor_.width_px) &&
           image.rows == static_cast<int>(sensor_.height_px);
  };
  const std::string expected_size =
      std::to_string(sensor_.width_px) + "x" + std::to_string(sensor_.height_px);
  const cv::Mat depth = imageOf(entry.depth, cv::IMREAD_UNCHANGED);
  if (!fits(depth) || depth.type() != CV_16UC1)
    return std::unexpected(entry.depth.string() + ": not a 16-bit grey PNG of " + expected_size);
  Pictures pictures;
  pictures.depth_mm.assign(depth.begin<std::uint16_t>(), depth.end<std::uint16_t>());
  if (entry.colour.empty()) return pictures;
  cv::Mat colour = imageOf(entry.colour, cv::IMREAD_COLOR);
  if (!fits(colour)) {
    pictures.remark = entry.colour.string() + ": not a picture of " + expected_size;
    return pictures;
  }
  cv::cvtColor(colour, colour, cv::COLOR_BGR2RGB);
  pictures.colour_rgb.assign(colour.datastart, colour.dataend);
  return pictures;
}

}  // namespace hal::openni

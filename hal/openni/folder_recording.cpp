#include "hal/openni/folder_recording.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <toml++/toml.h>

#include "rt/printable.h"

namespace hal::openni {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kFormat = 1;
constexpr double kLargestSide_px = 8192;

std::optional<std::uint64_t> wholeNumber(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Two numbers above 0 of an array, none larger than @p limit.
std::optional<std::array<double, 2>> pairOf(const toml::table& table, std::string_view key,
                                            double limit) {
  const toml::array* array = table[key].as_array();
  if (array == nullptr || array->size() != 2) return std::nullopt;
  std::array<double, 2> pair{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto value = array->get(i)->value<double>();
    if (!value || !(*value > 0) || !(*value <= limit)) return std::nullopt;
    pair[i] = *value;
  }
  return pair;
}

/// The pictures of a folder by their numbers; other files are none of our business.
std::map<std::uint64_t, fs::path> numbered(const fs::path& folder) {
  std::map<std::uint64_t, fs::path> found;
  std::error_code failed;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, failed)) {
    const std::string kind = file.path().extension();
    if (kind != ".png" && kind != ".jpg" && kind != ".jpeg") continue;
    if (const auto number = wholeNumber(file.path().stem().string()))
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
  const std::string where = file.string() + ": ";
  toml::table table;
  try {
    table = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    return std::unexpected(where + rt::printable(error.description()) +
                           ": a recording's folder holds a sensor.toml");
  }
  if (table["format"].value<std::int64_t>() != kFormat)
    return std::unexpected(where + "format must be 1, the one this version reads");
  const auto size = pairOf(table, "size_px", kLargestSide_px);
  const auto focal = pairOf(table, "focal_px", 1e6);
  if (!size || !focal || std::floor((*size)[0]) != (*size)[0] ||
      std::floor((*size)[1]) != (*size)[1]) {
    return std::unexpected(where +
                           "size_px and focal_px must be two numbers each, e.g. "
                           "size_px = [640, 480], focal_px = [570.0, 570.0]");
  }
  width_px_ = static_cast<std::uint32_t>((*size)[0]);
  height_px_ = static_cast<std::uint32_t>((*size)[1]);
  const std::array<double, 2> middle{0.5 * (width_px_ - 1.0), 0.5 * (height_px_ - 1.0)};
  const auto centre = pairOf(table, "centre_px", kLargestSide_px).value_or(middle);
  lens_ = {(*focal)[0], (*focal)[1], centre[0], centre[1]};
  name_ = rt::printable(table["name"].value_or(std::string(file.parent_path().filename())));
  rate_hz_ = table["rate_hz"].value_or(30.0);
  if (!(rate_hz_ >= 0.1 && rate_hz_ <= 1000))
    return std::unexpected(where + "rate_hz must be 0.1 to 1000");
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
         .stamp_us = static_cast<std::uint64_t>(std::llround(order * 1e6 / rate_hz_)),
         .depth = depth,
         .colour = colour == colours.end() ? fs::path() : colour->second});
  }
  if (!entries_.empty()) return {};
  return std::unexpected((folder / "depth").string() +
                         ": holds no picture: they are named by their numbers, 000001.png");
}

std::expected<void, std::string> FolderRecording::readStamps(const fs::path& file) {
  std::ifstream in(file);
  std::map<std::uint64_t, std::uint64_t> stamps;
  std::string line;
  for (int row = 1; std::getline(in, line); ++row) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty() || (row == 1 && line == "number,stamp_us")) continue;
    const std::size_t comma = line.find(',');
    const std::string_view text = line;
    const auto number = wholeNumber(text.substr(0, comma));
    const auto stamp_us = comma == std::string::npos ? std::optional<std::uint64_t>()
                                                     : wholeNumber(text.substr(comma + 1));
    if (!number || !stamp_us) {
      return std::unexpected(file.string() + ":" + std::to_string(row) +
                             ": must be two whole numbers, number,stamp_us");
    }
    stamps[*number] = *stamp_us;
  }
  for (Entry& entry : entries_) {
    const auto stamp = stamps.find(entry.number);
    if (stamp == stamps.end()) {
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
    return image.cols == static_cast<int>(width_px_) && image.rows == static_cast<int>(height_px_);
  };
  const std::string expected_size = std::to_string(width_px_) + "x" + std::to_string(height_px_);
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

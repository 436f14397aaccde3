#include "hal/openni/folder_text.h"

#include <array>
#include <charconv>
#include <cmath>

#include <toml++/toml.h>

#include "rt/printable.h"

namespace hal::openni {
namespace {

constexpr std::int64_t kFormat = 1;
constexpr double kLargestSide_px = 8192;

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

/// Five numbers, or none at all.
std::optional<std::array<double, 5>> distortionOf(const toml::table& table) {
  std::array<double, 5> distortion{};
  if (!table.contains("distortion")) return distortion;
  const toml::array* array = table["distortion"].as_array();
  if (array == nullptr || array->size() != distortion.size()) return std::nullopt;
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    const auto value = array->get(i)->value<double>();
    if (!value || !std::isfinite(*value)) return std::nullopt;
    distortion[i] = *value;
  }
  return distortion;
}

}  // namespace

std::optional<std::uint64_t> folderNumber(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::expected<FolderSensorFile, std::string> parseFolderSensor(std::string_view text,
                                                               const std::string& where) {
  toml::table table;
  try {
    table = toml::parse(text);
  } catch (const toml::parse_error& error) {
    return std::unexpected(where + ": " + rt::printable(error.description()) +
                           ": a recording's folder holds a sensor.toml");
  }
  // Exact: what converts a fraction to a whole number has no answer for 1e62.
  if (table["format"].value_exact<std::int64_t>() != kFormat)
    return std::unexpected(where + ": format must be 1, the one this version reads");
  const auto size = pairOf(table, "size_px", kLargestSide_px);
  const auto focal = pairOf(table, "focal_px", 1e6);
  if (!size || !focal || std::floor((*size)[0]) != (*size)[0] ||
      std::floor((*size)[1]) != (*size)[1]) {
    return std::unexpected(where +
                           ": size_px and focal_px must be two numbers each, e.g. "
                           "size_px = [640, 480], focal_px = [570.0, 570.0]");
  }
  FolderSensorFile sensor{.name = rt::printable(table["name"].value_or(std::string())),
                          .width_px = static_cast<std::uint32_t>((*size)[0]),
                          .height_px = static_cast<std::uint32_t>((*size)[1]),
                          .lens = {},
                          .rate_hz = table["rate_hz"].value_or(30.0)};
  const std::array<double, 2> middle{0.5 * (sensor.width_px - 1.0), 0.5 * (sensor.height_px - 1.0)};
  const auto centre = pairOf(table, "centre_px", kLargestSide_px).value_or(middle);
  const auto distortion = distortionOf(table);
  if (!distortion)
    return std::unexpected(where + ": distortion must be five numbers: k1, k2, p1, p2, k3");
  sensor.lens = {(*focal)[0], (*focal)[1], centre[0], centre[1], *distortion};
  if (!(sensor.rate_hz >= 0.1 && sensor.rate_hz <= 1000))
    return std::unexpected(where + ": rate_hz must be 0.1 to 1000");
  return sensor;
}

std::expected<std::map<std::uint64_t, std::uint64_t>, std::string> parseFolderStamps(
    std::string_view text, const std::string& where) {
  std::map<std::uint64_t, std::uint64_t> stamps;
  for (int row = 1; !text.empty(); ++row) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || (row == 1 && line == "number,stamp_us")) continue;
    const std::size_t comma = line.find(',');
    const auto number = folderNumber(line.substr(0, comma));
    const auto stamp_us = comma == std::string_view::npos ? std::optional<std::uint64_t>()
                                                          : folderNumber(line.substr(comma + 1));
    if (!number || !stamp_us) {
      return std::unexpected(where + ":" + std::to_string(row) +
                             ": must be two whole numbers, number,stamp_us");
    }
    stamps[*number] = *stamp_us;
  }
  return stamps;
}

}  // namespace hal::openni

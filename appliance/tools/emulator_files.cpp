#include "appliance/tools/emulator_files.h"

#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace appliance {
namespace {

/// 73 years in nanoseconds: sums of instants stay far from overflow.
constexpr std::int64_t kLargest = std::int64_t{1} << 61;

std::optional<std::array<std::int64_t, 7>> sevenNumbers(std::string_view line) {
  std::array<std::int64_t, 7> numbers{};
  const char* at = line.data();
  const char* end = at + line.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto read = std::from_chars(at, end, numbers[i]);
    if (read.ec != std::errc{} || numbers[i] < 0 || numbers[i] > kLargest) return std::nullopt;
    at = read.ptr;
  }
  if (at != end) return std::nullopt;
  return numbers;
}

}  // namespace

std::optional<SentFrame> parseWireLine(std::string_view line) {
  const auto n = sevenNumbers(line);
  if (!n || !std::in_range<std::uint32_t>((*n)[0])) return std::nullopt;
  return SentFrame{.camera = static_cast<std::uint32_t>((*n)[0]),
                   .frame_id = static_cast<std::uint64_t>((*n)[1]),
                   .trigger = static_cast<std::uint64_t>((*n)[2]),
                   .trigger_edge = rt::fromNs((*n)[3]),
                   .exposure_end = rt::fromNs((*n)[4]),
                   .first_packet = rt::fromNs((*n)[5]),
                   .last_packet = rt::fromNs((*n)[6])};
}

std::expected<std::vector<SentFrame>, std::string> readWireLog(std::istream& in,
                                                               const std::string& name) {
  std::string line;
  if (!std::getline(in, line) || line != kWireLogHeader)
    return std::unexpected(name + ":1: not a wire log of kagami-emulator");
  std::vector<SentFrame> frames;
  for (std::size_t count = 2; std::getline(in, line); ++count) {
    if (in.eof()) break;
    const auto frame = parseWireLine(line);
    if (!frame)
      return std::unexpected(name + ":" + std::to_string(count) +
                             ": not seven whole numbers with commas between");
    frames.push_back(*frame);
  }
  return frames;
}

std::expected<EmulatorStatistics, std::string> readEmulatorStatistics(std::istream& in,
                                                                      const std::string& name) {
  const auto json = nlohmann::json::parse(in, nullptr, false);
  const auto has = [&](const char* key, bool (nlohmann::json::*is)() const) {
    return json.contains(key) && (json[key].*is)();
  };
  if (!json.is_object() || !has("valid", &nlohmann::json::is_boolean) ||
      !has("invalid_reason", &nlohmann::json::is_string) ||
      !has("frames_sent", &nlohmann::json::is_number_unsigned) ||
      !has("cpu_seconds", &nlohmann::json::is_number))
    return std::unexpected(name + ": not the statistics of kagami-emulator");
  return EmulatorStatistics{.valid = json["valid"].get<bool>(),
                            .invalid_reason = json["invalid_reason"].get<std::string>(),
                            .frames_sent = json["frames_sent"].get<std::uint64_t>(),
                            .cpu_seconds = json["cpu_seconds"].get<double>()};
}

}  // namespace appliance

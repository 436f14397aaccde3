#pragma once

#include <cstdint>
#include <expected>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt/clock.h"

/// What kagami-emulator leaves behind: the far side's account of the same run.
namespace appliance {

/// One frame as it was really sent.
struct SentFrame {
  std::uint32_t camera = 0;
  std::uint64_t frame_id = 0;  ///< as on the wire: 1 to 65535, then 1 again
  std::uint64_t trigger = 0;   ///< rising edges seen on the wire, from 1
  rt::Timestamp trigger_edge;
  rt::Timestamp exposure_end;
  rt::Timestamp first_packet;
  rt::Timestamp last_packet;
};

struct EmulatorStatistics {
  bool valid = false;
  std::string invalid_reason;
  std::uint64_t frames_sent = 0;
  double cpu_seconds = 0;
};

/// A wire log's first line.
inline constexpr std::string_view kWireLogHeader =
    "camera,frame_id,trigger,trigger_edge_ns,exposure_end_ns,first_packet_ns,last_packet_ns";

/// Any other line of it, without its newline; nothing when it is none.
[[nodiscard]] std::optional<SentFrame> parseWireLine(std::string_view line);

/// Errors   One line "NAME:LINE: what". A last line without its newline (the emulator was killed)
///          is left out.
[[nodiscard]] std::expected<std::vector<SentFrame>, std::string> readWireLog(
    std::istream& in, const std::string& name);
[[nodiscard]] std::expected<EmulatorStatistics, std::string> readEmulatorStatistics(
    std::istream& in, const std::string& name);

}  // namespace appliance

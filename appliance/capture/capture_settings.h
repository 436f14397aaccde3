#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/pixel_format.h"
#include "hal/resend_policy.h"

namespace appliance {

class Section;

struct CamerasSettings {
  std::string backend = "aravis";
  std::vector<std::string> addresses;  ///< IPv4, in the order of the rig file
  std::string trigger_source = "Line1";
  hal::PixelFormat pixel_format = hal::PixelFormat::kBayerRG8;
  double exposure_us = 1000;
  double gain_db = 0;
  std::array<double, 3> white_balance_rgb{1, 1, 1};
  std::uint32_t packet_size_bytes = 9000;
  std::int32_t packet_delay_ns = -1;  ///< below 0: by the network plan
  std::uint32_t socket_buffer_bytes = 4U << 20;
  std::vector<double> opto_delay_us;  ///< one per camera; empty: all the same
  bool operator==(const CamerasSettings&) const = default;
};

/// Reads `[cameras]`.
void read(Section section, CamerasSettings& cameras);

/// Packets that did not arrive; frame_retention_us 0: four fifths of the trigger's period.
struct ResendSettings {
  hal::ResendPolicy policy{.frame_retention_us = 0};
  std::vector<hal::ModelResendPolicy> models;  ///< for these instead
  bool operator==(const ResendSettings&) const = default;
};

/// Reads `[resend]`.
void read(Section section, ResendSettings& resend);

struct TriggerSettings {
  std::string backend = "emulated";
  double rate_hz = 40;
  double pulse_width_us = 100;
  std::uint32_t wire_port = 3990;  ///< of the emulator, on this machine
  std::vector<std::string> lines;  ///< GPIO lines by name
  bool active_low = false;
  std::string loopback_line;  ///< empty: the trigger's edges are not measured
  bool loopback_active_low = false;
  bool genlock = true;              ///< in phase with the screen where the rates allow it
  double genlock_margin_us = 1500;  ///< frame_ready to the latest start of its warp
  bool operator==(const TriggerSettings&) const = default;
};

/// Reads `[trigger]`.
void read(Section section, TriggerSettings& trigger);

struct HistorySettings {
  std::uint32_t sets = 300;
  std::uint32_t in_flight = 8;  ///< slots per camera
  bool size_down = true;
  bool operator==(const HistorySettings&) const = default;
};

/// Reads `[history]`.
void read(Section section, HistorySettings& history);

}  // namespace appliance

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/pixel_format.h"
#include "hal/resend_policy.h"

namespace hal {

/// In place of a trigger source: a camera without a hardware trigger runs at its own rate, and
/// its frames go to the nearest edge. For cross-checks, never for a rig.
inline constexpr std::string_view kFreeRunning = "free-running";

/// Everything that must be in force in a camera before its first frame counts: pushed
/// as a whole and read back, because cameras forget their settings with their power.
struct CameraProfile {
  std::string name;     ///< for messages: "cam07"
  std::string address;  ///< IPv4; cameras are opened by address, never by discovery

  std::uint32_t width_px = 1280;
  std::uint32_t height_px = 1024;
  PixelFormat pixel_format = PixelFormat::kBayerRG8;

  double exposure_us = 1000;  ///< all automatic functions are switched off
  double gain_db = 0;
  std::array<double, 3> white_balance_rgb{1, 1, 1};  ///< in the camera; equal for all of a rig
  std::string trigger_source = "Line1";              ///< or kFreeRunning
  double trigger_delay_us = 0;  ///< from the edge at the camera to its exposure

  std::uint32_t packet_size_bytes = 9000;  ///< IP datagram; explicit, never negotiated
  std::uint32_t packet_delay_ns = 0;       ///< between two packets, beyond the link's own pace
  std::uint32_t socket_buffer_bytes = 4U << 20;
  ResendPolicy resend;
  std::vector<ModelResendPolicy> resend_by_model;  ///< for the models that need another one
  double link_mbps = 0;  ///< what the plan counts on; a slower link is reported. 0: any
};

}  // namespace hal

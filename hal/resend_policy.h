#pragma once

#include <cstdint>
#include <string>

namespace hal {

/// How packets that did not arrive are asked for again, and when a frame is given up.
///
/// Frames are delivered in order, so an incomplete one holds up those behind it until it is
/// complete or given up. It cannot hold up a later frame if frame_retention_us is below the
/// trigger's period: its last packet came a period before the last one of the next frame.
struct ResendPolicy {
  bool enabled = true;
  /// A packet asked for and not there after this is asked for again; whole milliseconds, and
  /// longer than the camera takes to answer.
  std::uint32_t packet_timeout_us = 3000;
  /// From the gap to the first request: for networks that change the order of packets.
  std::uint32_t initial_packet_timeout_us = 0;
  /// From a frame's last packet until it is given up, incomplete.
  std::uint32_t frame_retention_us = 20000;
  /// Most packets of a frame that are asked for again, as a share of all its packets: a frame
  /// that lost more is not worth the load.
  double request_ratio = 1;
  bool operator==(const ResendPolicy&) const = default;
};

/// What cameras of one model need instead.
struct ModelResendPolicy {
  std::string model;  ///< as the camera names itself
  ResendPolicy policy;
  bool operator==(const ModelResendPolicy&) const = default;
};

}  // namespace hal

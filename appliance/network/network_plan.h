#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include "appliance/words/phrase.h"
#include "rt/clock.h"

namespace appliance {

/// The cameras' way into this machine: every camera on a link of its own into a switch, the switch
/// on one or more equal uplinks, the cameras spread over them evenly.
struct NetworkParameters {
  std::uint32_t cameras = 20;
  std::uint32_t width_px = 1280;
  std::uint32_t height_px = 1024;  ///< one byte a pixel
  double rate_hz = 40;
  std::uint32_t packet_size_bytes = 9000;  ///< the IP datagram
  std::uint32_t uplinks = 2;
  double uplink_gbps = 10;
  double camera_link_gbps = 1;
  bool operator==(const NetworkParameters&) const = default;
};

/// No link is planned fuller than this: resends, control and clocks need the rest.
inline constexpr double kLinkShare = 0.95;

/// What one frame is on the wire.
struct FrameOnWire {
  std::uint32_t packets = 0;       ///< with leader and trailer
  std::uint64_t packet_bytes = 0;  ///< of a full packet, preamble and gap included
  std::uint64_t bytes = 0;         ///< of all of them

  [[nodiscard]] double bits() const { return 8.0 * static_cast<double>(bytes); }
};

/// Sizes in bytes, by their sources. Ethernet (IEEE 802.3): preamble and delimiter 8, header 14,
/// checksum 4, gap 12, at least 46 in between. IPv4 (RFC 791) 20, UDP (RFC 768) 8. GVSP (GigE
/// Vision, 16 bit block ids): header 8, image leader 36, image trailer 8.
[[nodiscard]] FrameOnWire frameOnWire(std::uint64_t frame_bytes, std::uint32_t packet_size_bytes);

/// How the frames will travel.
struct NetworkPlan {
  /// Between two packets of one camera (GevSCPD), so that all cameras together fill an uplink to
  /// kLinkShare and no more.
  rt::Nanoseconds packet_delay{0};
  rt::Nanoseconds transfer{0};        ///< of a frame, first to last packet, with that delay
  double camera_gbps = 0;             ///< one camera's mean
  double camera_link_use = 0;         ///< of its link, 1: full
  double uplink_gbps = 0;             ///< the fullest uplink's mean
  double uplink_use = 0;              ///< of it, 1: full
  std::uint64_t buffer_bytes = 0;     ///< what the switch must hold for one uplink
  std::uint64_t undelayed_bytes = 0;  ///< the same without the packet delay
  double highest_rate_hz = 0;         ///< that this network carries
};

/// A change of refused parameters that makes them possible.
struct NetworkAlternative {
  Phrase change;  ///< "lower the rate to 44.9 Hz"
  NetworkParameters parameters;
};

struct NetworkRefusal {
  Phrase reason;  ///< "20 cameras at 60 Hz need 12.7 Gb/s, ..."
  std::vector<NetworkAlternative> alternatives;

  /// Reason and alternatives as one line.
  [[nodiscard]] std::string line() const;
};

/// Pure. @p parameters has at least one camera, pixel and uplink, packets of 576 bytes or more, and
/// speeds and rates above 0.
[[nodiscard]] std::expected<NetworkPlan, NetworkRefusal> planNetwork(
    const NetworkParameters& parameters);

/// The rate at which the first link is full to kLinkShare.
[[nodiscard]] double highestRate_hz(const NetworkParameters& parameters);

/// "1 x 10 Gb/s"
[[nodiscard]] std::string uplinkWords(const NetworkParameters& parameters);

}  // namespace appliance

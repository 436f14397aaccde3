#include "appliance/network/network_plan.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <optional>

namespace appliance {
namespace {

constexpr std::uint64_t kEthernetBytes = 8 + 14 + 4 + 12;
constexpr std::uint64_t kShortestEthernetPayload = 46;
constexpr std::uint64_t kProtocolBytes = 20 + 8 + 8;  // IP, UDP, GVSP
constexpr std::uint64_t kLeaderBytes = kProtocolBytes + 36;
constexpr std::uint64_t kTrailerBytes = kProtocolBytes + 8;

/// A frame has left before the next one is due, with this much of the period to spare.
constexpr double kPeriodShare = 0.98;

// Where alternatives are looked for.
constexpr std::uint32_t kSmallestHeight_px = 240;
constexpr std::uint32_t kHeightStep_px = 2;  // whole Bayer cells
constexpr std::uint32_t kMostUplinks = 4;
constexpr std::uint32_t kJumboPacketBytes = 9000;
constexpr std::array kUplinkSpeeds_gbps = {1.0, 2.5, 5.0, 10.0, 25.0, 40.0, 100.0};

std::uint64_t wireBytes(std::uint64_t datagram_bytes) {
  return std::max(datagram_bytes, kShortestEthernetPayload) + kEthernetBytes;
}

FrameOnWire frameOf(const NetworkParameters& parameters) {
  return frameOnWire(std::uint64_t{parameters.width_px} * parameters.height_px,
                     parameters.packet_size_bytes);
}

std::uint32_t camerasPerUplink(const NetworkParameters& parameters) {
  return (parameters.cameras + parameters.uplinks - 1) / parameters.uplinks;
}

rt::Nanoseconds seconds(double s) {
  return rt::Nanoseconds{std::llround(s * 1e9)};
}

/// The delay that gives every camera its share of the uplink, unless the frame would then not
/// have left before the next one.
double packetDelay_s(const NetworkParameters& parameters, const FrameOnWire& frame) {
  const double link_bps = parameters.camera_link_gbps * 1e9;
  const double share_bps = kLinkShare * parameters.uplink_gbps * 1e9 / camerasPerUplink(parameters);
  const double packet_bits = 8.0 * static_cast<double>(frame.packet_bytes);
  const double fair_s = packet_bits / share_bps - packet_bits / link_bps;
  const double longest_s =
      (kPeriodShare / parameters.rate_hz - frame.bits() / link_bps) / (frame.packets - 1);
  return std::max(0.0, std::min(fair_s, longest_s));
}

/// All cameras of an uplink send at the same time: one packet of each has to wait, and what arrives
/// faster than the uplink carries it piles up until the frames have passed.
std::uint64_t switchBuffer(const NetworkParameters& parameters, const FrameOnWire& frame,
                           double delay_s) {
  const double link_bps = parameters.camera_link_gbps * 1e9;
  const double packet_bits = 8.0 * static_cast<double>(frame.packet_bytes);
  const double paced_bps = packet_bits / (packet_bits / link_bps + delay_s);
  const double excess_bps = camerasPerUplink(parameters) * paced_bps - parameters.uplink_gbps * 1e9;
  const double piled_bits = std::max(0.0, excess_bps) * frame.bits() / paced_bps;
  return camerasPerUplink(parameters) * frame.packet_bytes +
         static_cast<std::uint64_t>(std::ceil(piled_bits / 8));
}

bool fits(const NetworkParameters& parameters) {
  return parameters.rate_hz <= highestRate_hz(parameters);
}

std::optional<NetworkAlternative> lowerRate(NetworkParameters parameters) {
  const double wanted_hz = parameters.rate_hz;
  parameters.rate_hz = std::floor(highestRate_hz(parameters) * 10) / 10;
  if (parameters.rate_hz <= 0 || parameters.rate_hz >= wanted_hz) return std::nullopt;
  return NetworkAlternative{phrase<Word::kNetworkLowerRate>(parameters.rate_hz), parameters};
}

std::optional<NetworkAlternative> smallerHeight(NetworkParameters parameters) {
  // A frame's bytes on the wire rise with its height: the largest height that fits is searched by
  // halves.
  const std::uint32_t tallest = (parameters.height_px - 1) / kHeightStep_px;
  std::uint32_t fitting = kSmallestHeight_px / kHeightStep_px;
  std::uint32_t too_tall = tallest + 1;
  const auto fitsAt = [&](std::uint32_t steps) {
    parameters.height_px = steps * kHeightStep_px;
    return fits(parameters);
  };
  if (fitting >= too_tall || !fitsAt(fitting)) return std::nullopt;
  while (too_tall - fitting > 1) {
    const std::uint32_t middle = fitting + (too_tall - fitting) / 2;
    (fitsAt(middle) ? fitting : too_tall) = middle;
  }
  parameters.height_px = fitting * kHeightStep_px;
  return NetworkAlternative{phrase<Word::kNetworkLowerHeight>(parameters.height_px), parameters};
}

std::optional<NetworkAlternative> moreUplinks(NetworkParameters parameters) {
  for (++parameters.uplinks; parameters.uplinks <= std::min(kMostUplinks, parameters.cameras);
       ++parameters.uplinks) {
    if (fits(parameters))
      return NetworkAlternative{phrase<Word::kNetworkUplinks>(uplinkWords(parameters)), parameters};
  }
  return std::nullopt;
}

std::optional<NetworkAlternative> fasterUplink(NetworkParameters parameters) {
  for (const double speed : kUplinkSpeeds_gbps) {
    if (speed <= parameters.uplink_gbps) continue;
    parameters.uplink_gbps = speed;
    if (fits(parameters))
      return NetworkAlternative{phrase<Word::kNetworkUplinks>(uplinkWords(parameters)), parameters};
  }
  return std::nullopt;
}

std::optional<NetworkAlternative> largerPackets(NetworkParameters parameters) {
  if (parameters.packet_size_bytes >= kJumboPacketBytes) return std::nullopt;
  parameters.packet_size_bytes = kJumboPacketBytes;
  if (!fits(parameters)) return std::nullopt;
  return NetworkAlternative{phrase<Word::kNetworkPackets>(kJumboPacketBytes), parameters};
}

NetworkRefusal refusal(const NetworkParameters& parameters) {
  const double camera_gbps = frameOf(parameters).bits() * parameters.rate_hz * 1e-9;
  const double uplink_gbps = camera_gbps * camerasPerUplink(parameters);
  NetworkRefusal refused;
  const NetworkParameters& p = parameters;
  const double carried_gbps = kLinkShare * p.uplink_gbps;
  if (uplink_gbps <= carried_gbps)
    refused.reason = phrase<Word::kNetworkCamera>(p.width_px, p.height_px, p.rate_hz, camera_gbps,
                                                  kLinkShare * p.camera_link_gbps);
  else if (p.uplinks == 1)
    refused.reason = phrase<Word::kNetworkUplink>(p.cameras, p.width_px, p.height_px, p.rate_hz,
                                                  uplink_gbps, uplinkWords(p), carried_gbps);
  else
    refused.reason = phrase<Word::kNetworkFullest>(p.cameras, p.width_px, p.height_px, p.rate_hz,
                                                   uplink_gbps, uplinkWords(p), carried_gbps);
  for (const auto& way : {lowerRate, smallerHeight, moreUplinks, fasterUplink, largerPackets}) {
    if (auto found = way(parameters)) refused.alternatives.push_back(std::move(*found));
  }
  return refused;
}

}  // namespace

FrameOnWire frameOnWire(std::uint64_t frame_bytes, std::uint32_t packet_size_bytes) {
  const std::uint64_t payload = packet_size_bytes - kProtocolBytes;
  const std::uint64_t full = frame_bytes / payload;
  const std::uint64_t rest = frame_bytes % payload;
  FrameOnWire frame{.packets = static_cast<std::uint32_t>(full + (rest != 0 ? 1 : 0) + 2),
                    .packet_bytes = wireBytes(packet_size_bytes),
                    .bytes = wireBytes(kLeaderBytes) + wireBytes(kTrailerBytes)};
  frame.bytes += full * frame.packet_bytes;
  if (rest != 0) frame.bytes += wireBytes(rest + kProtocolBytes);
  return frame;
}

double highestRate_hz(const NetworkParameters& parameters) {
  const double bits = frameOf(parameters).bits();
  return kLinkShare * 1e9 / bits *
         std::min(parameters.camera_link_gbps,
                  parameters.uplink_gbps / camerasPerUplink(parameters));
}

std::expected<NetworkPlan, NetworkRefusal> planNetwork(const NetworkParameters& parameters) {
  assert(parameters.cameras > 0 && parameters.uplinks > 0 && parameters.rate_hz > 0);
  if (!fits(parameters)) return std::unexpected(refusal(parameters));
  const FrameOnWire frame = frameOf(parameters);
  const double delay_s = std::ceil(packetDelay_s(parameters, frame) * 1e9) * 1e-9;
  const double camera_gbps = frame.bits() * parameters.rate_hz * 1e-9;
  const double uplink_gbps = camera_gbps * camerasPerUplink(parameters);
  return NetworkPlan{.packet_delay = seconds(delay_s),
                     .transfer = seconds(frame.bits() / (parameters.camera_link_gbps * 1e9) +
                                         delay_s * (frame.packets - 1)),
                     .camera_gbps = camera_gbps,
                     .camera_link_use = camera_gbps / parameters.camera_link_gbps,
                     .uplink_gbps = uplink_gbps,
                     .uplink_use = uplink_gbps / parameters.uplink_gbps,
                     .buffer_bytes = switchBuffer(parameters, frame, delay_s),
                     .undelayed_bytes = switchBuffer(parameters, frame, 0),
                     .highest_rate_hz = highestRate_hz(parameters)};
}

std::string uplinkWords(const NetworkParameters& parameters) {
  std::array<char, 48> text{};
  (void)std::snprintf(text.data(), text.size(), "%u x %.4g Gb/s", parameters.uplinks,
                      parameters.uplink_gbps);
  return text.data();
}

std::string NetworkRefusal::line() const {
  std::string text = textOf(reason);
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    text += (i == 0 ? ": " : ", or ") + textOf(alternatives[i].change);
  }
  return text;
}

}  // namespace appliance

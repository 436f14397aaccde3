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

FrameOnWire frameOf(const NetworkWish& wish) {
  return frameOnWire(std::uint64_t{wish.width_px} * wish.height_px, wish.packet_size_bytes);
}

std::uint32_t camerasPerUplink(const NetworkWish& wish) {
  return (wish.cameras + wish.uplinks - 1) / wish.uplinks;
}

rt::Nanoseconds seconds(double s) {
  return rt::Nanoseconds{std::llround(s * 1e9)};
}

/// The delay that gives every camera its share of the uplink, unless the frame would then not
/// have left before the next one.
double packetDelay_s(const NetworkWish& wish, const FrameOnWire& frame) {
  const double link_bps = wish.camera_link_gbps * 1e9;
  const double share_bps = kLinkShare * wish.uplink_gbps * 1e9 / camerasPerUplink(wish);
  const double packet_bits = 8.0 * static_cast<double>(frame.packet_bytes);
  const double fair_s = packet_bits / share_bps - packet_bits / link_bps;
  const double longest_s =
      (kPeriodShare / wish.rate_hz - frame.bits() / link_bps) / (frame.packets - 1);
  return std::max(0.0, std::min(fair_s, longest_s));
}

/// All cameras of an uplink send at once: one packet each has to wait, and what comes faster than
/// the uplink takes it away piles up until the frames are through.
std::uint64_t switchBuffer(const NetworkWish& wish, const FrameOnWire& frame, double delay_s) {
  const double link_bps = wish.camera_link_gbps * 1e9;
  const double packet_bits = 8.0 * static_cast<double>(frame.packet_bytes);
  const double paced_bps = packet_bits / (packet_bits / link_bps + delay_s);
  const double excess_bps = camerasPerUplink(wish) * paced_bps - wish.uplink_gbps * 1e9;
  const double piled_bits = std::max(0.0, excess_bps) * frame.bits() / paced_bps;
  return camerasPerUplink(wish) * frame.packet_bytes +
         static_cast<std::uint64_t>(std::ceil(piled_bits / 8));
}

std::string words(const char* format, auto... values) {
  std::array<char, 200> text{};
  (void)std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

bool fits(const NetworkWish& wish) {
  return wish.rate_hz <= highestRate_hz(wish);
}

std::optional<NetworkAlternative> lowerRate(NetworkWish wish) {
  const double wanted_hz = wish.rate_hz;
  wish.rate_hz = std::floor(highestRate_hz(wish) * 10) / 10;
  if (wish.rate_hz <= 0 || wish.rate_hz >= wanted_hz) return std::nullopt;
  return NetworkAlternative{words("lower the rate to %.1f Hz", wish.rate_hz), wish};
}

std::optional<NetworkAlternative> smallerHeight(NetworkWish wish) {
  // A frame's bytes on the wire rise with its height: the largest height that fits is searched by
  // halves.
  const std::uint32_t tallest = (wish.height_px - 1) / kHeightStep_px;
  std::uint32_t fitting = kSmallestHeight_px / kHeightStep_px;
  std::uint32_t too_tall = tallest + 1;
  const auto fitsAt = [&](std::uint32_t steps) {
    wish.height_px = steps * kHeightStep_px;
    return fits(wish);
  };
  if (fitting >= too_tall || !fitsAt(fitting)) return std::nullopt;
  while (too_tall - fitting > 1) {
    const std::uint32_t middle = fitting + (too_tall - fitting) / 2;
    (fitsAt(middle) ? fitting : too_tall) = middle;
  }
  wish.height_px = fitting * kHeightStep_px;
  return NetworkAlternative{words("lower the pictures' height to %u px", wish.height_px), wish};
}

std::optional<NetworkAlternative> moreUplinks(NetworkWish wish) {
  for (++wish.uplinks; wish.uplinks <= std::min(kMostUplinks, wish.cameras); ++wish.uplinks) {
    if (fits(wish)) return NetworkAlternative{"use " + uplinkWords(wish) + " uplinks", wish};
  }
  return std::nullopt;
}

std::optional<NetworkAlternative> fasterUplink(NetworkWish wish) {
  for (const double speed : kUplinkSpeeds_gbps) {
    if (speed <= wish.uplink_gbps) continue;
    wish.uplink_gbps = speed;
    if (fits(wish)) return NetworkAlternative{"use " + uplinkWords(wish) + " uplinks", wish};
  }
  return std::nullopt;
}

std::optional<NetworkAlternative> largerPackets(NetworkWish wish) {
  if (wish.packet_size_bytes >= kJumboPacketBytes) return std::nullopt;
  wish.packet_size_bytes = kJumboPacketBytes;
  if (!fits(wish)) return std::nullopt;
  return NetworkAlternative{words("use packets of %u bytes", kJumboPacketBytes), wish};
}

NetworkRefusal refusal(const NetworkWish& wish) {
  const double camera_gbps = frameOf(wish).bits() * wish.rate_hz * 1e-9;
  const double uplink_gbps = camera_gbps * camerasPerUplink(wish);
  NetworkRefusal refused;
  if (uplink_gbps > kLinkShare * wish.uplink_gbps) {
    refused.reason =
        words("%u cameras of %ux%u at %.4g Hz need %.3g Gb/s of ", wish.cameras, wish.width_px,
              wish.height_px, wish.rate_hz, uplink_gbps) +
        (wish.uplinks == 1 ? "the uplink" : "the fullest uplink") +
        words(", %s carries %.3g", uplinkWords(wish).c_str(), kLinkShare * wish.uplink_gbps);
  } else {
    refused.reason =
        words("a camera of %ux%u at %.4g Hz needs %.3g Gb/s, its link carries %.3g", wish.width_px,
              wish.height_px, wish.rate_hz, camera_gbps, kLinkShare * wish.camera_link_gbps);
  }
  for (const auto& way : {lowerRate, smallerHeight, moreUplinks, fasterUplink, largerPackets}) {
    if (auto found = way(wish)) refused.alternatives.push_back(std::move(*found));
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

double highestRate_hz(const NetworkWish& wish) {
  const double bits = frameOf(wish).bits();
  return kLinkShare * 1e9 / bits *
         std::min(wish.camera_link_gbps, wish.uplink_gbps / camerasPerUplink(wish));
}

std::expected<NetworkPlan, NetworkRefusal> planNetwork(const NetworkWish& wish) {
  assert(wish.cameras > 0 && wish.uplinks > 0 && wish.rate_hz > 0);
  if (!fits(wish)) return std::unexpected(refusal(wish));
  const FrameOnWire frame = frameOf(wish);
  const double delay_s = std::ceil(packetDelay_s(wish, frame) * 1e9) * 1e-9;
  const double camera_gbps = frame.bits() * wish.rate_hz * 1e-9;
  const double uplink_gbps = camera_gbps * camerasPerUplink(wish);
  return NetworkPlan{.packet_delay = seconds(delay_s),
                     .transfer = seconds(frame.bits() / (wish.camera_link_gbps * 1e9) +
                                         delay_s * (frame.packets - 1)),
                     .camera_gbps = camera_gbps,
                     .camera_link_use = camera_gbps / wish.camera_link_gbps,
                     .uplink_gbps = uplink_gbps,
                     .uplink_use = uplink_gbps / wish.uplink_gbps,
                     .buffer_bytes = switchBuffer(wish, frame, delay_s),
                     .undelayed_bytes = switchBuffer(wish, frame, 0),
                     .highest_rate_hz = highestRate_hz(wish)};
}

std::string uplinkWords(const NetworkWish& wish) {
  return words("%u x %.4g Gb/s", wish.uplinks, wish.uplink_gbps);
}

std::string NetworkRefusal::line() const {
  std::string text = reason;
  for (std::size_t i = 0; i < alternatives.size(); ++i) {
    text += (i == 0 ? ": " : ", or ") + alternatives[i].words;
  }
  return text;
}

}  // namespace appliance

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <arv.h>

#include "hal/camera_profile.h"

namespace hal::aravis {

/// The packets with which a camera is to stream.
struct PacketSize {
  std::uint32_t bytes = 0;     ///< the IP datagram
  std::uint32_t delay_ns = 0;  ///< between two of them, in proportion to their size
  std::string note;            ///< why not as requested, without the camera's name; may be empty
  bool operator==(const PacketSize&) const = default;
};

/// Sizes to try: the asked one, then the usual ones below it, largest first.
[[nodiscard]] std::vector<std::uint32_t> packetSizesBelow(std::uint32_t asked_bytes);

/// Scales the packet delay with the packet's size on the wire, so that the camera keeps its share
/// of the uplink.
[[nodiscard]] std::uint32_t delayForSize(const CameraProfile& profile, std::uint32_t bytes);

/// Has the camera send test packets (GigE Vision: one datagram of the very size, never cut into
/// fragments) and takes the largest size that arrives: nothing else proves an MTU that lies on
/// switches as well as on network cards. Call it before the stream is made: the camera
/// streams to no receiver meanwhile. Some milliseconds; 0.2 s for every size that does not arrive.
///
/// If no size arrives, the requested one stays, with a note: the camera may have no test packets.
[[nodiscard]] PacketSize provePacketSize(ArvCamera* camera, const CameraProfile& profile);

}  // namespace hal::aravis

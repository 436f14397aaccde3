#pragma once

#include <cstdint>
#include <span>

#include <netinet/in.h>

#include "hal/emulated/rig/gvsp.h"
#include "hal/emulated/rig/packet_faults.h"

namespace emulator {

/// Puts runs of one frame's packets on a UDP socket: few system calls, and no copy of ours
/// but of payloads that an overlay replaces a part of.
///
/// Equal packets leave as one super-packet that the kernel cuts (UDP_SEGMENT), where the
/// kernel can; else one message each, as on a wire that reorders or doubles packets. Never skips
/// a packet unasked: what did not go out is not in Outcome::packets.
class PacketSender {
 public:
  struct Outcome {
    std::uint32_t packets = 0;  ///< handled from the front: sent, or lost on purpose
    std::uint32_t lost_on_purpose = 0;
    std::uint32_t doubled = 0;
    std::uint32_t overtaken = 0;
    std::uint64_t bytes = 0;  ///< GVSP bytes sent
    int os_errno = 0;         ///< why the next packet did not go out; EAGAIN: try again later
  };

  /// @p fd stays the caller's: a UDP socket, not blocking.
  explicit PacketSender(int fd);

  /// Sends packets [first, first + count) of @p frame; the range lies inside the frame.
  Outcome send(const sockaddr_in& to, const gvsp::Frame& frame, std::uint32_t first,
               std::uint32_t count, PacketFaults& faults);

  /// Most payload packets that fit one super-packet.
  [[nodiscard]] static std::uint32_t packetsPerMessage(std::uint32_t payload_per_packet);

 private:
  Outcome sendInRuns(const sockaddr_in& to, const gvsp::Frame& frame, std::uint32_t first,
                     std::uint32_t count, PacketFaults& faults);
  Outcome sendOneByOne(const sockaddr_in& to, const gvsp::Frame& frame, std::uint32_t first,
                       std::uint32_t count, PacketFaults& faults);

  int fd_;
  bool can_segment_;
};

}  // namespace emulator

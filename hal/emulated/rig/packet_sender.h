#pragma once

#include <cstdint>
#include <random>
#include <span>

#include <netinet/in.h>

#include "hal/emulated/rig/gvsp.h"

namespace emulator {

/// Packets that the emulated wire swallows on purpose, the same ones for the same seed.
class LossModel {
 public:
  LossModel(double probability, std::uint64_t seed) : lost_(probability), engine_(seed) {}
  [[nodiscard]] bool loses() { return lost_.p() > 0 && lost_(engine_); }

 private:
  std::bernoulli_distribution lost_;
  std::mt19937_64 engine_;
};

/// Puts runs of one frame's packets on a UDP socket: few system calls, no copy of ours.
///
/// Equal packets leave as one super-packet that the kernel cuts (UDP_SEGMENT), where the
/// kernel can; else one message each. Never skips a packet unasked: what did not go out is
/// not in Outcome::packets.
class PacketSender {
 public:
  struct Outcome {
    std::uint32_t packets = 0;  ///< handled from the front: sent, or lost on purpose
    std::uint32_t lost_on_purpose = 0;
    std::uint64_t bytes = 0;  ///< GVSP bytes sent
    int os_errno = 0;         ///< why the next packet did not go out; EAGAIN: try again later
  };

  /// @p fd stays the caller's: a UDP socket, not blocking.
  explicit PacketSender(int fd);

  /// Sends packets [first, first + count) of @p frame; the range lies inside the frame.
  Outcome send(const sockaddr_in& to, const gvsp::Frame& frame, std::uint32_t first,
               std::uint32_t count, LossModel& loss);

  /// Most payload packets that fit one super-packet.
  [[nodiscard]] static std::uint32_t packetsPerMessage(std::uint32_t payload_per_packet);

 private:
  int fd_;
  bool can_segment_;
};

}  // namespace emulator

#pragma once

#include <cstdint>

#include "rt/clock.h"

namespace emulator {

/// How fast one camera's link carries its packets.
struct LinkTiming {
  double bits_per_second = 1e9;
  std::uint32_t packet_bytes = 1500;  ///< the IP datagram
  rt::Nanoseconds packet_delay{0};    ///< GevSCPD

  /// From one packet's start to the next one's: Ethernet adds 38 bytes (header, checksum,
  /// preamble, gap).
  [[nodiscard]] rt::Nanoseconds perPacket() const;
};

/// When which packets of a frame leave: a link that starts at `start` has carried packet n
/// entirely after (n + 1) x perPacket(). Groups of packets leave when their last one would
/// have left a real camera; the leader leaves alone and immediately, because its arrival
/// marks the exposure's end. A late sender catches up immediately: lateness never adds up.
///
/// Pure: time is an argument.
class Pacing {
 public:
  struct Due {
    std::uint32_t first;
    std::uint32_t count;
    rt::Timestamp at;
  };

  Pacing(rt::Timestamp start, const LinkTiming& link, std::uint32_t packets,
         std::uint32_t most_at_once);

  [[nodiscard]] bool done() const { return next_ == packets_; }
  /// The group that leaves next; not when done().
  [[nodiscard]] Due next() const;
  void advance(std::uint32_t packets) { next_ += packets; }
  /// When the last packet has left, on a link that is never late.
  [[nodiscard]] rt::Timestamp scheduledEnd() const;

 private:
  rt::Timestamp start_;
  rt::Nanoseconds per_packet_;
  std::uint32_t packets_;
  std::uint32_t group_;
  std::uint32_t next_ = 0;
};

}  // namespace emulator

#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/emulated/rig/overlay.h"

/// GigE Vision stream protocol: how one frame becomes packets. Pure.
namespace emulator::gvsp {

inline constexpr std::uint32_t kPixelMono8 = 0x0108'0001;
inline constexpr std::uint32_t kPixelBayerRG8 = 0x0108'0009;

inline constexpr std::size_t kHeaderBytes = 8;
inline constexpr std::size_t kLeaderBytes = kHeaderBytes + 36;
inline constexpr std::size_t kTrailerBytes = kHeaderBytes + 8;
/// A packet size counts the IP datagram; this much of it is IP, UDP and GVSP header.
inline constexpr std::uint32_t kPacketOverheadBytes = 20 + 8 + 8;

/// The pixels of one frame in up to three pieces, one after the other, and what replaces some of
/// them.
/// Memory   Borrowed: the scene or the camera's frame store owns the bytes.
struct Picture {
  using Pieces = std::array<std::span<const std::uint8_t>, 3>;
  Pieces pieces;
  Overlay overlay;

  [[nodiscard]] std::size_t bytes() const {
    return pieces[0].size() + pieces[1].size() + pieces[2].size();
  }
  /// What the pieces have of @p count pixels from @p first on, without what replaces them.
  [[nodiscard]] Pieces piecesOf(std::size_t first, std::size_t count) const;
  /// Writes the pixels from @p first on, as they are seen.
  void copyTo(std::span<std::uint8_t> part, std::size_t first) const;
};

/// One frame as it goes out: packet 0 is the leader, then the payload, last the trailer.
struct Frame {
  std::uint16_t block_id = 0;   ///< 1..65535, 0 stands for "no frame"
  std::uint64_t timestamp = 0;  ///< camera clock, ticks of 1 ns
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint32_t offset_x_px = 0;
  std::uint32_t offset_y_px = 0;
  std::uint32_t pixel_format = 0;
  std::uint32_t payload_per_packet = 0;  ///< bytes
  Picture picture;

  [[nodiscard]] std::uint32_t packetCount() const {
    const auto bytes = static_cast<std::uint32_t>(picture.bytes());
    return (bytes + payload_per_packet - 1) / payload_per_packet + 2;
  }
};

using Header = std::array<std::uint8_t, kHeaderBytes>;
using Leader = std::array<std::uint8_t, kLeaderBytes>;
using Trailer = std::array<std::uint8_t, kTrailerBytes>;

[[nodiscard]] Leader encodeLeader(const Frame& frame);
[[nodiscard]] Header encodePayloadHeader(std::uint16_t block_id, std::uint32_t packet_id);
[[nodiscard]] Trailer encodeTrailer(const Frame& frame);
/// Says that a packet asked for again is gone from the camera's memory.
[[nodiscard]] Header encodeUnavailable(std::uint16_t block_id, std::uint32_t packet_id);

}  // namespace emulator::gvsp

#include "hal/emulated/rig/gvsp.h"

#include <algorithm>
#include <cstring>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/gvcp.h"

namespace emulator::gvsp {
namespace {

enum Format : std::uint32_t { kLeader = 1, kTrailer = 2, kPayload = 3 };
constexpr std::uint16_t kPayloadTypeImage = 1;

void storeHeader(std::uint8_t* p, gvcp::Status status, std::uint16_t block_id, Format format,
                 std::uint32_t packet_id) {
  storeBe16(p, static_cast<std::uint16_t>(status));
  storeBe16(p + 2, block_id);
  storeBe32(p + 4, format << 24 | (packet_id & 0x00ff'ffff));
}

}  // namespace

Picture::Pieces Picture::piecesOf(std::size_t first, std::size_t count) const {
  Pieces parts;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto rest = pieces[i].subspan(std::min(first, pieces[i].size()));
    parts[i] = rest.first(std::min(count, rest.size()));
    first -= std::min(first, pieces[i].size());
    count -= parts[i].size();
  }
  return parts;
}

void Picture::copyTo(std::span<std::uint8_t> part, std::size_t first) const {
  std::uint8_t* to = part.data();
  for (const auto& piece : piecesOf(first, part.size())) {
    if (!piece.empty()) std::memcpy(to, piece.data(), piece.size());
    to += piece.size();
  }
  overlay.putInto(part, first);
}

Leader encodeLeader(const Frame& frame) {
  Leader bytes{};
  storeHeader(bytes.data(), gvcp::Status::kSuccess, frame.block_id, kLeader, 0);
  std::uint8_t* p = bytes.data() + kHeaderBytes;
  storeBe16(p + 2, kPayloadTypeImage);
  storeBe32(p + 4, static_cast<std::uint32_t>(frame.timestamp >> 32));
  storeBe32(p + 8, static_cast<std::uint32_t>(frame.timestamp));
  storeBe32(p + 12, frame.pixel_format);
  storeBe32(p + 16, frame.width_px);
  storeBe32(p + 20, frame.height_px);
  storeBe32(p + 24, frame.offset_x_px);
  storeBe32(p + 28, frame.offset_y_px);
  return bytes;  // the last word, padding in x and y, stays zero
}

Header encodePayloadHeader(std::uint16_t block_id, std::uint32_t packet_id) {
  Header bytes;
  storeHeader(bytes.data(), gvcp::Status::kSuccess, block_id, kPayload, packet_id);
  return bytes;
}

Trailer encodeTrailer(const Frame& frame) {
  Trailer bytes{};
  storeHeader(bytes.data(), gvcp::Status::kSuccess, frame.block_id, kTrailer,
              frame.packetCount() - 1);
  storeBe32(bytes.data() + kHeaderBytes, kPayloadTypeImage);
  storeBe32(bytes.data() + kHeaderBytes + 4, frame.height_px);
  return bytes;
}

Header encodeUnavailable(std::uint16_t block_id, std::uint32_t packet_id) {
  Header bytes;
  storeHeader(bytes.data(), gvcp::Status::kPacketUnavailable, block_id, kPayload, packet_id);
  return bytes;
}

}  // namespace emulator::gvsp

#include "hal/emulated/rig/packet_sender.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>

#include <netinet/udp.h>
#include <sys/socket.h>
#include <sys/uio.h>

namespace emulator {
namespace {

constexpr std::uint32_t kMaxSegments = 64;  // of the kernel, UDP_MAX_SEGMENTS
constexpr std::uint32_t kMaxDatagramBytes = 65'000;
constexpr std::size_t kMaxMessages = 64;
constexpr std::size_t kMaxPackets = 256;
constexpr std::size_t kPiecesPerPacket = 4;  // header, and a payload in up to three pieces
/// Payloads of which an overlay replaces a part are put together here, two messages of them: that
/// little stays in the processor's nearest caches.
constexpr std::size_t kComposedBytes = 2 * kMaxDatagramBytes;

/// The messages of one sendmmsg call under construction.
class Batch {
 public:
  explicit Batch(const sockaddr_in& to) : to_(to) {}

  [[nodiscard]] bool isFull() const {
    return messages_ == kMaxMessages || packets_ + kMaxSegments > kMaxPackets ||
           composed_bytes_ + kMaxDatagramBytes > kComposedBytes;
  }
  [[nodiscard]] std::size_t messages() const { return messages_; }
  [[nodiscard]] std::uint32_t packetsOf(std::size_t message) const { return counts_[message]; }
  [[nodiscard]] std::uint64_t bytesOf(std::size_t message) const { return sizes_[message]; }
  [[nodiscard]] mmsghdr* data(std::size_t first) { return &headers_[first]; }

  void open() {
    msghdr& message = headers_[messages_].msg_hdr;
    message = {};
    message.msg_name = &to_;
    message.msg_namelen = sizeof to_;
    message.msg_iov = &pieces_[piece_count_];
    counts_[messages_] = 0;
    sizes_[messages_] = 0;
  }

  /// Adds packet @p id of @p frame to the open message.
  void add(const gvsp::Frame& frame, std::uint32_t id) {
    std::uint8_t* header = headers_bytes_[packets_++].data();
    const std::uint32_t last = frame.packetCount() - 1;
    if (id == 0) {
      const auto leader = gvsp::encodeLeader(frame);
      std::memcpy(header, leader.data(), leader.size());
      addPiece(header, leader.size());
    } else if (id == last) {
      const auto trailer = gvsp::encodeTrailer(frame);
      std::memcpy(header, trailer.data(), trailer.size());
      addPiece(header, trailer.size());
    } else {
      const auto head = gvsp::encodePayloadHeader(frame.block_id, id);
      std::memcpy(header, head.data(), head.size());
      addPiece(header, head.size());
      addPayload(frame, std::size_t{id - 1} * frame.payload_per_packet);
    }
    ++counts_[messages_];
  }

  void close(std::uint32_t segment_bytes) {
    msghdr& message = headers_[messages_].msg_hdr;
    message.msg_iovlen = static_cast<std::size_t>(&pieces_[piece_count_] - message.msg_iov);
    if (counts_[messages_] > 1) {
      message.msg_control = controls_[messages_].bytes.data();
      message.msg_controllen = controls_[messages_].bytes.size();
      cmsghdr* control = CMSG_FIRSTHDR(&message);
      control->cmsg_level = SOL_UDP;
      control->cmsg_type = UDP_SEGMENT;
      control->cmsg_len = CMSG_LEN(sizeof(std::uint16_t));
      const auto segment = static_cast<std::uint16_t>(segment_bytes);
      std::memcpy(CMSG_DATA(control), &segment, sizeof segment);
    }
    ++messages_;
  }

 private:
  struct Control {
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(std::uint16_t))> bytes{};
  };

  void addPiece(const std::uint8_t* data, std::size_t bytes) {
    pieces_[piece_count_++] = {const_cast<std::uint8_t*>(data), bytes};
    sizes_[messages_] += bytes;
  }

  void addPayload(const gvsp::Frame& frame, std::size_t offset) {
    const std::size_t bytes =
        std::min<std::size_t>(frame.payload_per_packet, frame.picture.bytes() - offset);
    if (frame.picture.overlay.touches(offset, bytes)) {
      const auto payload = std::span(composed_).subspan(composed_bytes_, bytes);
      composed_bytes_ += bytes;
      frame.picture.copyTo(payload, offset);
      addPiece(payload.data(), payload.size());
      return;
    }
    for (const auto& piece : frame.picture.piecesOf(offset, bytes))
      if (!piece.empty()) addPiece(piece.data(), piece.size());
  }

  sockaddr_in to_;
  std::size_t messages_ = 0;
  std::size_t packets_ = 0;
  std::size_t piece_count_ = 0;
  std::array<mmsghdr, kMaxMessages> headers_;
  std::array<std::uint32_t, kMaxMessages> counts_;
  std::array<std::uint64_t, kMaxMessages> sizes_;
  std::array<Control, kMaxMessages> controls_;
  std::array<iovec, kMaxPackets * kPiecesPerPacket> pieces_;
  std::array<gvsp::Leader, kMaxPackets> headers_bytes_;  // a leader is the longest header
  std::size_t composed_bytes_ = 0;
  std::array<std::uint8_t, kComposedBytes> composed_;
};

/// As the path's MTU counts it, IP header and all.
std::uint32_t datagramBytes(const gvsp::Frame& frame, std::uint32_t id) {
  constexpr std::uint32_t kIpUdp = 28;
  const std::uint32_t last = frame.packetCount() - 1;
  if (id == 0) return gvsp::kLeaderBytes + kIpUdp;
  if (id == last) return gvsp::kTrailerBytes + kIpUdp;
  const std::size_t before = std::size_t{id - 1} * frame.payload_per_packet;
  const auto left = static_cast<std::uint32_t>(frame.picture.bytes() - before);
  return std::min(frame.payload_per_packet, left) + gvsp::kPacketOverheadBytes;
}

bool canSegment(int fd) {
  const int off = 0;
  return ::setsockopt(fd, SOL_UDP, UDP_SEGMENT, &off, sizeof off) == 0;
}

}  // namespace

PacketSender::PacketSender(int fd) : fd_(fd), can_segment_(canSegment(fd)) {}

std::uint32_t PacketSender::packetsPerMessage(std::uint32_t payload_per_packet) {
  const std::uint32_t packet = payload_per_packet + gvsp::kHeaderBytes;
  return std::clamp(kMaxDatagramBytes / packet, 1u, kMaxSegments);
}

PacketSender::Outcome PacketSender::send(const sockaddr_in& to, const gvsp::Frame& frame,
                                         std::uint32_t first, std::uint32_t count,
                                         PacketFaults& faults) {
  const bool plain =
      !faults.rearranges() && faults.carries(frame.payload_per_packet + gvsp::kPacketOverheadBytes);
  return plain ? sendInRuns(to, frame, first, count, faults)
               : sendOneByOne(to, frame, first, count, faults);
}

PacketSender::Outcome PacketSender::sendInRuns(const sockaddr_in& to, const gvsp::Frame& frame,
                                               std::uint32_t first, std::uint32_t count,
                                               PacketFaults& faults) {
  Outcome outcome;
  const std::uint32_t trailer = frame.packetCount() - 1;
  const std::uint32_t end = first + count;
  const std::uint32_t per_message = can_segment_ ? packetsPerMessage(frame.payload_per_packet) : 1;
  const std::uint32_t segment_bytes =
      frame.payload_per_packet + static_cast<std::uint32_t>(gvsp::kHeaderBytes);

  std::uint32_t next = first;
  while (next < end) {
    Batch batch(to);
    std::array<std::uint32_t, kMaxMessages> ends;  // where packets are settled after a message
    std::array<std::uint32_t, kMaxMessages> lost_before{};
    std::uint32_t lost = 0;
    while (next < end && !batch.isFull()) {
      if (faults.loses()) {
        ++next;
        ++lost;
        continue;
      }
      batch.open();
      batch.add(frame, next++);
      const bool is_payload = next - 1 != 0 && next - 1 != trailer;
      bool lost_one = false;
      while (is_payload && !lost_one && next < end && next != trailer &&
             batch.packetsOf(batch.messages()) < per_message) {
        lost_one = faults.loses();
        if (!lost_one) batch.add(frame, next);
        ++next;
      }
      ends[batch.messages()] = next;
      lost_before[batch.messages()] = lost + (lost_one ? 1 : 0);
      lost = lost_before[batch.messages()];
      batch.close(segment_bytes);
    }

    std::size_t sent = 0;
    while (sent < batch.messages()) {
      const int accepted =
          ::sendmmsg(fd_, batch.data(sent), static_cast<unsigned>(batch.messages() - sent), 0);
      if (accepted < 0 && errno == EINTR) continue;
      if (accepted < 0) {
        outcome.os_errno = errno;
        if (sent > 0) {
          outcome.packets = ends[sent - 1] - first;
          outcome.lost_on_purpose += lost_before[sent - 1];
        }
        return outcome;
      }
      for (int i = 0; i < accepted; ++i) outcome.bytes += batch.bytesOf(sent++);
    }
    outcome.packets = next - first;
    outcome.lost_on_purpose += lost;
  }
  return outcome;
}

PacketSender::Outcome PacketSender::sendOneByOne(const sockaddr_in& to, const gvsp::Frame& frame,
                                                 std::uint32_t first, std::uint32_t count,
                                                 PacketFaults& faults) {
  Outcome settled;  // up to the last packet of which nothing is left to send
  std::uint32_t next = first;
  const std::uint32_t end = first + count;
  while (next < end) {
    Batch batch(to);
    Outcome drawn = settled;
    const bool overtaken = next + 1 < end && faults.overtaken();
    drawn.overtaken += overtaken ? 1 : 0;
    const std::array<std::uint32_t, 2> order = {overtaken ? next + 1 : next, next};
    const std::size_t packets = overtaken ? 2 : 1;
    for (const std::uint32_t id : std::span(order).first(packets)) {
      if (!faults.carries(datagramBytes(frame, id)) || faults.loses()) {
        ++drawn.lost_on_purpose;
        continue;
      }
      const bool doubled = faults.doubled();
      drawn.doubled += doubled ? 1 : 0;
      for (int copies = doubled ? 2 : 1; copies > 0; --copies) {
        batch.open();
        batch.add(frame, id);
        drawn.bytes += batch.bytesOf(batch.messages());
        batch.close(0);
      }
    }
    // A pair that went out by half is sent again whole: one more duplicate on such a wire.
    const auto wanted = static_cast<unsigned>(batch.messages());
    int accepted = 0;
    do {
      accepted = wanted == 0 ? 0 : ::sendmmsg(fd_, batch.data(0), wanted, 0);
    } while (accepted < 0 && errno == EINTR);
    if (accepted != static_cast<int>(wanted)) {
      settled.os_errno = accepted < 0 ? errno : EAGAIN;
      return settled;
    }
    next += static_cast<std::uint32_t>(packets);
    settled = drawn;
    settled.packets = next - first;
  }
  return settled;
}

}  // namespace emulator

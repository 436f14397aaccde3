#include "hal/emulated/rig/gvcp.h"

#include <cassert>

#include "hal/emulated/rig/bytes.h"

namespace emulator::gvcp {
namespace {

constexpr std::uint8_t kKey = 0x42;
constexpr std::uint8_t kAcknowledgeFlag = 0x01;

enum Code : std::uint16_t {
  kDiscovery = 0x0002,
  kPacketResend = 0x0040,
  kReadRegister = 0x0080,
  kWriteRegister = 0x0082,
  kReadMemory = 0x0084,
  kWriteMemory = 0x0086,
  kAction = 0x0100,
};

constexpr std::uint32_t kPacketIdMask = 0x00ff'ffff;

bool isWholeList(std::span<const std::uint8_t> list, std::size_t entry_bytes) {
  return !list.empty() && list.size() % entry_bytes == 0 && list.size() <= kMaxPayloadBytes;
}

}  // namespace

std::optional<Command> parse(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kHeaderBytes || datagram[0] != kKey) return std::nullopt;
  Command command;
  command.wants_answer = (datagram[1] & kAcknowledgeFlag) != 0;
  command.code = loadBe16(&datagram[2]);
  const std::size_t length = loadBe16(&datagram[4]);
  command.request_id = loadBe16(&datagram[6]);
  if (length > datagram.size() - kHeaderBytes) return std::nullopt;
  const auto payload = datagram.subspan(kHeaderBytes, length);
  const std::uint8_t* p = payload.data();

  switch (command.code) {
    case kDiscovery:
      command.body = Discovery{};
      return command;
    case kReadRegister:
      if (!isWholeList(payload, 4)) return std::nullopt;
      command.body = ReadRegister{payload};
      return command;
    case kWriteRegister:
      if (!isWholeList(payload, 8)) return std::nullopt;
      command.body = WriteRegister{payload};
      return command;
    case kReadMemory:
      if (length < 8) return std::nullopt;
      command.body = ReadMemory{loadBe32(p), loadBe16(p + 6)};
      return command;
    case kWriteMemory:
      if (length < 8) return std::nullopt;
      command.body = WriteMemory{loadBe32(p), payload.subspan(4)};
      return command;
    case kPacketResend:
      if (length < 12) return std::nullopt;
      command.body = PacketResend{loadBe16(p + 2), loadBe32(p + 4) & kPacketIdMask,
                                  loadBe32(p + 8) & kPacketIdMask};
      return command;
    case kAction:
      if (length < 12) return std::nullopt;
      command.body = Action{loadBe32(p), loadBe32(p + 4), loadBe32(p + 8)};
      return command;
    default:
      return command;
  }
}

std::span<std::uint8_t> Answer::append(std::size_t bytes) {
  assert(payload_bytes_ + bytes <= kMaxPayloadBytes);
  const auto room = std::span(bytes_).subspan(kHeaderBytes + payload_bytes_, bytes);
  payload_bytes_ += bytes;
  return room;
}

void Answer::append32(std::uint32_t value) {
  storeBe32(append(4).data(), value);
}

std::span<const std::uint8_t> Answer::finish(Status status) {
  storeBe16(&bytes_[0], static_cast<std::uint16_t>(status));
  storeBe16(&bytes_[2], static_cast<std::uint16_t>(code_ + 1));
  storeBe16(&bytes_[4], static_cast<std::uint16_t>(payload_bytes_));
  storeBe16(&bytes_[6], request_id_);
  return std::span(bytes_).first(kHeaderBytes + payload_bytes_);
}

}  // namespace emulator::gvcp

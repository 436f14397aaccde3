#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

/// GigE Vision control protocol: what a controller says and how a camera answers. Pure.
namespace emulator::gvcp {

inline constexpr std::uint16_t kPort = 3956;
inline constexpr std::size_t kHeaderBytes = 8;
inline constexpr std::size_t kMaxPayloadBytes = 540;  ///< 576-byte datagrams less IP, UDP, header
inline constexpr std::size_t kMaxMemoryBytes = 536;   ///< of one READMEM

enum class Status : std::uint16_t {
  kSuccess = 0x0000,
  kNotImplemented = 0x8001,
  kInvalidParameter = 0x8002,
  kInvalidAddress = 0x8003,
  kWriteProtect = 0x8004,
  kBadAlignment = 0x8005,
  kAccessDenied = 0x8006,
  kBusy = 0x8007,
  kPacketUnavailable = 0x800c,
};

struct Discovery {};
struct ReadRegister {
  std::span<const std::uint8_t> addresses;  ///< big-endian words
};
struct WriteRegister {
  std::span<const std::uint8_t> pairs;  ///< big-endian address, value
};
struct ReadMemory {
  std::uint32_t address;
  std::uint16_t bytes;
};
struct WriteMemory {
  std::uint32_t address;
  std::span<const std::uint8_t> data;
};
struct PacketResend {
  std::uint16_t block_id;
  std::uint32_t first_packet;
  std::uint32_t last_packet;  ///< inclusive
};
struct Action {
  std::uint32_t device_key;
  std::uint32_t group_key;
  std::uint32_t group_mask;
};
/// A well-formed command that this device does not know.
struct Unknown {};

struct Command {
  std::uint16_t code = 0;
  std::uint16_t request_id = 0;
  bool wants_answer = false;
  std::variant<Unknown, Discovery, ReadRegister, WriteRegister, ReadMemory, WriteMemory,
               PacketResend, Action>
      body;
};

/// Nothing when the datagram is not a GVCP command or its length does not fit its kind:
/// such datagrams get no answer. The command borrows the datagram's bytes.
[[nodiscard]] std::optional<Command> parse(std::span<const std::uint8_t> datagram);

/// The acknowledge of one command, built in place.
class Answer {
 public:
  explicit Answer(const Command& command) : code_(command.code), request_id_(command.request_id) {}

  /// Room for @p bytes more of payload, zeroed; the caller stays within kMaxPayloadBytes.
  [[nodiscard]] std::span<std::uint8_t> append(std::size_t bytes);
  void append32(std::uint32_t value);
  void dropPayload() { payload_bytes_ = 0; }

  /// The datagram to send back.
  [[nodiscard]] std::span<const std::uint8_t> finish(Status status);

 private:
  std::uint16_t code_;
  std::uint16_t request_id_;
  std::size_t payload_bytes_ = 0;
  std::array<std::uint8_t, kHeaderBytes + kMaxPayloadBytes> bytes_{};
};

}  // namespace emulator::gvcp

// The half of Camera that talks GVCP: registers, control privilege, resends.
#include <algorithm>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/camera.h"
#include "hal/emulated/rig/features.h"

namespace emulator {
namespace {

using gvcp::Status;

constexpr std::uint32_t kFireTestPacket = 1u << 31;
constexpr std::uint32_t kDoNotFragment = 1u << 30;
constexpr std::uint32_t kPacketSizeMask = 0xffff;
constexpr std::uint32_t kLatchTimestamp = 2;
constexpr std::uint32_t kPtpSlave = 9;
constexpr std::uint32_t kPtpDisabled = 3;

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

}  // namespace

void Camera::onControl(std::span<const std::uint8_t> datagram, const sockaddr_in& from,
                       rt::Timestamp now, const Reply& reply) {
  if (faults_.isDark(now)) return;
  const auto command = gvcp::parse(datagram);
  if (!command) return;
  const ControlChannel::Peer peer{ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)};
  control_.hear(peer, now);
  gvcp::Answer answer(*command);
  const Status status = execute(*command, peer, now, answer);
  const bool is_discovery = std::holds_alternative<gvcp::Discovery>(command->body);
  const bool is_resend = std::holds_alternative<gvcp::PacketResend>(command->body);
  const auto* action = std::get_if<gvcp::Action>(&command->body);
  if (action != nullptr && status != Status::kSuccess) return;  // meant for another camera
  if (is_resend || (!command->wants_answer && !is_discovery)) return;
  reply(answer.finish(status));
}

Status Camera::execute(const gvcp::Command& command, const ControlChannel::Peer& peer,
                       rt::Timestamp now, gvcp::Answer& answer) {
  return std::visit(
      Overloaded{
          [](const gvcp::Unknown&) { return Status::kNotImplemented; },
          [&](const gvcp::Discovery&) {
            std::ranges::copy(registers_.discoveryAnswer(),
                              answer.append(Registers::kDiscoveryBytes).begin());
            return Status::kSuccess;
          },
          [&](const gvcp::ReadRegister& c) {
            return readRegisters(c.addresses, control_.mayRead(peer), answer);
          },
          [&](const gvcp::WriteRegister& c) { return writeRegisters(c.pairs, peer, now, answer); },
          [&](const gvcp::ReadMemory& c) {
            if (!control_.mayRead(peer)) return Status::kAccessDenied;
            if (c.bytes > gvcp::kMaxMemoryBytes) return Status::kInvalidParameter;
            answer.append32(c.address);
            const Status status = registers_.readMemory(c.address, answer.append(c.bytes));
            if (status != Status::kSuccess) answer.dropPayload();
            return status;
          },
          [&](const gvcp::WriteMemory& c) {
            if (!control_.mayWrite(peer)) return Status::kAccessDenied;
            if (c.data.size() % 4 != 0) return Status::kBadAlignment;
            auto status = Status::kSuccess;
            std::size_t done = 0;
            while (done < c.data.size() && status == Status::kSuccess) {
              status = writeRegister(c.address + static_cast<std::uint32_t>(done),
                                     loadBe32(&c.data[done]), peer, now);
              if (status == Status::kSuccess) done += 4;
            }
            answer.append32(static_cast<std::uint32_t>(done));
            return status;
          },
          [&](const gvcp::PacketResend& c) {
            if (!control_.mayAskAgain(peer)) return Status::kAccessDenied;
            resend(c);
            return Status::kSuccess;
          },
          [&](const gvcp::Action& c) {
            if (c.device_key != registers_.get(reg::kActionDeviceKey) ||
                c.group_key != registers_.get(reg::kActionGroupKey) ||
                (c.group_mask & registers_.get(reg::kActionGroupMask)) == 0) {
              return Status::kInvalidParameter;
            }
            triggerOwn(TriggerSource::kAction1, now);
            return Status::kSuccess;
          }},
      command.body);
}

Status Camera::readRegisters(std::span<const std::uint8_t> addresses, bool may_read,
                             gvcp::Answer& answer) const {
  for (std::size_t at = 0; at < addresses.size(); at += 4) {
    const std::uint32_t address = loadBe32(&addresses[at]);
    // Any program may ask whether the camera is controlled, and by which program.
    if (address == reg::kControlPrivilege) {
      answer.append32(control_.privilege());
      continue;
    }
    if (address == reg::kControllerAddress || address == reg::kControllerPort) {
      const auto controller = control_.controller().value_or(ControlChannel::Peer{});
      answer.append32(address == reg::kControllerPort ? controller.port : controller.address);
      continue;
    }
    const Status status = may_read ? registers_.checkRead(address) : Status::kAccessDenied;
    if (status != Status::kSuccess) return status;
    answer.append32(registers_.get(address));
  }
  return Status::kSuccess;
}

Status Camera::writeRegisters(std::span<const std::uint8_t> pairs, const ControlChannel::Peer& peer,
                              rt::Timestamp now, gvcp::Answer& answer) {
  auto status = Status::kSuccess;
  std::uint32_t written = 0;
  for (std::size_t at = 0; at < pairs.size() && status == Status::kSuccess; at += 8) {
    status = writeRegister(loadBe32(&pairs[at]), loadBe32(&pairs[at + 4]), peer, now);
    if (status == Status::kSuccess) ++written;
  }
  answer.append32(written);
  return status;
}

Status Camera::writeRegister(std::uint32_t address, std::uint32_t value,
                             const ControlChannel::Peer& peer, rt::Timestamp now) {
  if (address == reg::kControlPrivilege) {
    const bool was_held = control_.isHeld();
    const Status status = control_.request(peer, value, now);
    if (was_held && !control_.isHeld()) stopAcquisition();
    return status;
  }
  if (!control_.mayWrite(peer)) return Status::kAccessDenied;
  const Status status = registers_.checkWrite(address, value, acquiring_);
  return status == Status::kSuccess ? applyWrite(address, value, now) : status;
}

Status Camera::applyWrite(std::uint32_t address, std::uint32_t value, rt::Timestamp now) {
  switch (address) {
    case reg::kAcquisitionStart:
      return startAcquisition(now);
    case reg::kAcquisitionStop:
      stopAcquisition();
      return Status::kSuccess;
    case reg::kTriggerSoftware:
      triggerOwn(TriggerSource::kSoftware, now);
      return Status::kSuccess;
    case reg::kDeviceReset:
      powerOn();
      return Status::kSuccess;
    case reg::kPtpLatch:
      return Status::kSuccess;
    case reg::kPtpEnable:
      registers_.set(reg::kPtpStatus, value != 0 ? kPtpSlave : kPtpDisabled);
      break;
    case reg::kTimestampControl:
      if ((value & kLatchTimestamp) != 0) {
        const std::uint64_t ticks = clockTicks(now);
        registers_.set(reg::kTimestampValueHigh, static_cast<std::uint32_t>(ticks >> 32));
        registers_.set(reg::kTimestampValueLow, static_cast<std::uint32_t>(ticks));
      }
      return Status::kSuccess;
    case reg::kStreamPacketSize:
      registers_.set(address, value & (kDoNotFragment | kPacketSizeMask));
      if ((value & kFireTestPacket) != 0) sendTestPacket();
      return Status::kSuccess;
    default:
      break;
  }
  registers_.set(address, value);
  return Status::kSuccess;
}

void Camera::resend(const gvcp::PacketResend& request) {
  const auto frame = std::ranges::find_if(history_, [&](const gvsp::Frame& f) {
    return f.block_id != 0 && f.block_id == request.block_id;
  });
  if (frame == history_.end()) {
    ++context_.counters.resends_unavailable;
    const auto gone = gvsp::encodeUnavailable(request.block_id, request.first_packet);
    const sockaddr_in to = destination();
    // Nothing to do when even this does not go out: the client's own timeout covers it.
    (void)::sendto(stream_fd_, gone.data(), gone.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                   sizeof to);
    return;
  }
  const std::uint32_t last = std::min(request.last_packet, frame->packetCount() - 1);
  if (request.first_packet > last) return;
  const auto outcome = sender_.send(destination(), *frame, request.first_packet,
                                    last - request.first_packet + 1, wire_faults_);
  if (outcome.lost_on_purpose > 0) {
    note(lossBecause(rt::now()), 0, frame->block_id, outcome.lost_on_purpose);
  }
  context_.counters.packets_resent += outcome.packets;
  context_.counters.packets_lost_on_purpose += outcome.lost_on_purpose;
  context_.counters.bytes_sent += outcome.bytes;
  if (outcome.os_errno != 0) {
    context_.counters.send_failures += last - request.first_packet + 1 - outcome.packets;
    context_.counters.last_send_errno = outcome.os_errno;
  }
}

void Camera::sendTestPacket() {
  const std::uint32_t packet_bytes = registers_.get(reg::kStreamPacketSize) & kPacketSizeMask;
  const std::vector<std::uint8_t> packet(packet_bytes - 28, 0xa5);  // less IP and UDP headers
  const sockaddr_in to = destination();
  if (!wire_faults_.carries(packet_bytes)) return;
  // A test packet that does not arrive is the answer that the client asked for.
  (void)::sendto(stream_fd_, packet.data(), packet.size(), 0,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

sockaddr_in Camera::destination() const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(registers_.get(reg::kStreamPort)));
  to.sin_addr.s_addr = htonl(registers_.get(reg::kStreamDestination));
  return to;
}

}  // namespace emulator

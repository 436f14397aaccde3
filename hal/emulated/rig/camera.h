#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <netinet/in.h>

#include "hal/emulated/rig/control_channel.h"
#include "hal/emulated/rig/features.h"
#include "hal/emulated/rig/frame_source.h"
#include "hal/emulated/rig/gvcp.h"
#include "hal/emulated/rig/gvsp.h"
#include "hal/emulated/rig/pacing.h"
#include "hal/emulated/rig/packet_sender.h"
#include "hal/emulated/rig/registers.h"
#include "hal/emulated/rig/run_record.h"
#include "hal/emulated/rig/scene.h"
#include "hal/emulated/rig/sensor.h"

namespace emulator {

/// What all cameras of one emulated rig share.
struct RigContext {
  Scene& scene;
  Counters& counters;
  LatenessHistogram& lateness;
  LossModel& loss;
  WireLog* wire_log;  ///< nullptr: none
  double link_bits_per_second;
  std::uint32_t max_packet_bytes;
  std::span<const char> xml;
};

/// One GigE Vision camera: registers and control channel on one socket, frames on another.
///
/// A trigger edge starts an exposure, its opto-isolator's delay and TriggerDelay later; its frame
/// leaves when the exposure has ended, paced like a real link. An edge is an overtrigger (counted,
/// ignored) while the previous exposure runs, and when its own exposure would end before the
/// previous frame has left.
///
/// Threads  One: the event loop.
class Camera {
 public:
  /// @p stream_fd stays the caller's.
  Camera(const Identity& identity, int stream_fd, RigContext& context);

  /// A datagram on the control socket. @p reply sends an answer back to @p from.
  using Reply = std::function<void(std::span<const std::uint8_t>)>;
  void onControl(std::span<const std::uint8_t> datagram, const sockaddr_in& from, rt::Timestamp now,
                 const Reply& reply);

  /// An edge of Line1. @p trigger counts rising edges, from 1.
  void onLine1(bool rising, rt::Timestamp edge, std::uint64_t trigger);

  /// Does what is due at @p now: ends exposures, sends packets, expires control.
  void advance(rt::Timestamp now);
  /// The next instant at which advance() has something to do.
  [[nodiscard]] rt::Timestamp nextDeadline() const;

 private:
  struct Transfer {
    std::uint32_t slot;
    Pacing pacing;
    SentFrame record;
  };

  gvcp::Status execute(const gvcp::Command& command, const ControlChannel::Peer& peer,
                       rt::Timestamp now, gvcp::Answer& answer);
  gvcp::Status readRegisters(std::span<const std::uint8_t> addresses, bool may_read,
                             gvcp::Answer& answer) const;
  gvcp::Status writeRegisters(std::span<const std::uint8_t> pairs, const ControlChannel::Peer& peer,
                              rt::Timestamp now, gvcp::Answer& answer);
  gvcp::Status writeRegister(std::uint32_t address, std::uint32_t value,
                             const ControlChannel::Peer& peer, rt::Timestamp now);
  gvcp::Status applyWrite(std::uint32_t address, std::uint32_t value, rt::Timestamp now);
  void resend(const gvcp::PacketResend& request);
  void sendTestPacket();

  gvcp::Status startAcquisition(rt::Timestamp now);
  void stopAcquisition();
  void powerOn();
  void trigger(rt::Timestamp edge, std::uint64_t number, rt::Nanoseconds input_delay);
  void triggerOwn(TriggerSource source, rt::Timestamp now);
  void startTransfer();
  void sendDue(rt::Timestamp now);
  void finishTransfer();

  [[nodiscard]] LinkTiming linkTiming() const;
  [[nodiscard]] rt::Nanoseconds freeRunPeriod() const;
  [[nodiscard]] sockaddr_in destination() const;
  [[nodiscard]] std::uint64_t clockTicks(rt::Timestamp at) const;

  Identity identity_;
  RigContext& context_;
  int stream_fd_;
  Registers registers_;
  ControlChannel control_;
  PacketSender sender_;
  FrameSource source_;

  bool acquiring_ = false;
  bool single_frame_ = false;
  std::uint64_t own_triggers_ = 0;  // exposures that no wire edge started
  rt::Timestamp next_free_run_;
  std::uint16_t last_block_id_ = 0;
  std::optional<Exposure> exposure_;
  std::optional<Transfer> transfer_;
  rt::Timestamp retry_at_;  // a full socket is asked again then
  std::uint32_t next_slot_ = 0;
  std::array<gvsp::Frame, kFrameHistory> history_{};
};

}  // namespace emulator

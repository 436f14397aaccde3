#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <netinet/in.h>

#include "hal/emulated/rig/camera_clock.h"
#include "hal/emulated/rig/control_channel.h"
#include "hal/emulated/rig/fault_command.h"
#include "hal/emulated/rig/fault_log.h"
#include "hal/emulated/rig/fault_state.h"
#include "hal/emulated/rig/features.h"
#include "hal/emulated/rig/frame_source.h"
#include "hal/emulated/rig/gvcp.h"
#include "hal/emulated/rig/gvsp.h"
#include "hal/emulated/rig/pacing.h"
#include "hal/emulated/rig/packet_faults.h"
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
  FaultLog* fault_log = nullptr;  ///< nullptr: none
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

  /// Begins or ends a fault; see docs/emulator.md.
  void applyFault(const FaultCommand& command, rt::Timestamp now);

  /// Does what is due at @p now: ends exposures, sends packets, expires control.
  void advance(rt::Timestamp now);
  /// The next instant at which advance() has something to do.
  [[nodiscard]] rt::Timestamp nextDeadline() const;

 private:
  struct Transfer {
    std::uint32_t slot;
    Pacing pacing;
    SentFrame record;
    rt::Nanoseconds held{0};  // by a fault, beyond the instant it was ready to leave
    std::uint32_t packets_lost = 0;
    std::optional<Fault> fault;  // whose doing it is that the link is not free
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
  PacketSender::Outcome put(const Pacing::Due& due, rt::Timestamp now);
  void finishTransfer();

  void showLinkSpeed();
  void stopBecause(Fault fault);
  void cutTransfer(Fault fault);
  [[nodiscard]] std::optional<Fault> busyBecause() const;
  [[nodiscard]] Fault lossBecause(rt::Timestamp now) const;
  void note(Fault fault, std::uint64_t trigger, std::uint16_t frame_id = 0,
            std::uint32_t packets_lost = 0);
  [[nodiscard]] double linkBitsPerSecond() const;

  [[nodiscard]] LinkTiming linkTiming() const;
  [[nodiscard]] rt::Nanoseconds freeRunPeriod() const;
  [[nodiscard]] sockaddr_in destination() const;
  [[nodiscard]] std::uint64_t clockTicks(rt::Timestamp at) const;
  [[nodiscard]] bool wantsExtraExposure() const;

  Identity identity_;
  RigContext& context_;
  int stream_fd_;
  Registers registers_;
  ControlChannel control_;
  PacketSender sender_;
  FrameSource source_;
  CameraClock clock_;
  FaultState faults_;
  PacketFaults wire_faults_;

  bool acquiring_ = false;
  bool single_frame_ = false;
  std::uint64_t own_triggers_ = 0;  // exposures that no wire edge started
  rt::Timestamp next_free_run_;
  std::uint16_t last_block_id_ = 0;
  std::optional<Exposure> exposure_;
  std::optional<Fault> exposure_fault_;  // which asked for it, instead of an edge
  std::optional<Transfer> transfer_;
  rt::Timestamp link_free_at_;       // when the frames begun so far will have left
  std::optional<Fault> link_fault_;  // which made it that late
  std::optional<Fault> stopped_by_;  // which ended the last acquisition
  rt::Timestamp retry_at_;           // a full socket is asked again then
  std::uint32_t next_slot_ = 0;
  std::array<gvsp::Frame, kFrameHistory> history_{};
};

}  // namespace emulator

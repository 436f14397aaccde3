// The part of Camera that does wrong on command, and says what came of it.
#include "hal/emulated/rig/camera.h"
#include "hal/emulated/rig/features.h"

namespace emulator {

void Camera::applyFault(const FaultCommand& command, rt::Timestamp now) {
  faults_.apply(command, now);
  switch (command.fault) {
    case Fault::kReboot:
      stopBecause(Fault::kReboot);
      powerOn();
      clock_.restart(now);
      break;
    case Fault::kFreeze:
      cutTransfer(Fault::kFreeze);
      exposure_.reset();
      break;
    case Fault::kDrift:
      clock_.drift(now, command.argument);
      break;
    case Fault::kLoss:
      wire_faults_.setLoss(command.argument / 100);
      break;
    case Fault::kReorder:
      wire_faults_.setReorder(command.argument / 100);
      break;
    case Fault::kDuplicate:
      wire_faults_.setDuplicate(command.argument / 100);
      break;
    case Fault::kMtu:
      wire_faults_.setMtu(static_cast<std::uint32_t>(command.argument));
      break;
    case Fault::kFrameId:
      last_block_id_ = static_cast<std::uint16_t>(command.argument - 1);
      break;
    case Fault::kLink:
      showLinkSpeed();
      break;
    case Fault::kClear:
      clock_.drift(now, 0);
      wire_faults_.clear();
      showLinkSpeed();
      break;
    case Fault::kIgnoreTriggers:
    case Fault::kIgnoreEvery:
    case Fault::kExtraFrame:
    case Fault::kLateLeader:
    case Fault::kKill:
    case Fault::kRevive:
    case Fault::kThaw:
    case Fault::kWrongSize:
      break;
  }
  if (context_.fault_log != nullptr) {
    context_.fault_log->addCommand(now, identity_.number, command);
  }
}

void Camera::showLinkSpeed() {
  registers_.set(reg::kLinkSpeed, static_cast<std::uint32_t>(linkBitsPerSecond() * 1e-6));
}

double Camera::linkBitsPerSecond() const {
  return faults_.linkMbps() > 0 ? faults_.linkMbps() * 1e6 : context_.link_bits_per_second;
}

/// A fault ends the acquisition: edges that come from now on are its doing.
void Camera::stopBecause(Fault fault) {
  if (acquiring_) stopped_by_ = fault;
  cutTransfer(fault);
  stopAcquisition();
}

void Camera::cutTransfer(Fault fault) {
  if (exposure_) note(fault, exposure_->trigger);
  if (!transfer_) return;
  note(fault, transfer_->record.trigger, transfer_->record.frame_id);
  ++context_.counters.frames_cut_short;
  transfer_.reset();
}

/// An edge found the camera busy: a fault's doing, or the client's?
std::optional<Fault> Camera::busyBecause() const {
  if (exposure_fault_) return exposure_fault_;
  if (transfer_ && transfer_->fault) return transfer_->fault;
  if (faults_.linkMbps() > 0) return Fault::kLink;
  return std::nullopt;
}

Fault Camera::lossBecause(rt::Timestamp now) const {
  if (faults_.isDark(now)) return faults_.darkBecause();
  const std::uint32_t packet = registers_.get(reg::kStreamPacketSize) & 0xffff;
  return wire_faults_.carries(packet) ? Fault::kLoss : Fault::kMtu;
}

void Camera::note(Fault fault, std::uint64_t trigger, std::uint16_t frame_id,
                  std::uint32_t packets_lost) {
  if (frame_id == 0) ++context_.counters.frames_withheld_on_purpose;
  if (context_.fault_log == nullptr) return;
  context_.fault_log->addEffect(rt::now(), identity_.number,
                                {fault, trigger, frame_id, packets_lost});
}

}  // namespace emulator

// The half of Camera that exposes and sends frames.
#include "hal/emulated/rig/camera.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

#include "hal/emulated/rig/features.h"

namespace emulator {
namespace {

constexpr rt::Nanoseconds kRetryAfter{200'000};
constexpr std::uint32_t kPacketSizeMask = 0xffff;

/// Up to 20 ppm fast or slow, another for each camera.
double clockErrorPpm(std::uint32_t camera) {
  return static_cast<double>(camera * 37 % 41) - 20;
}

rt::Nanoseconds fromMicroseconds(float us) {
  return rt::Nanoseconds{std::llround(static_cast<double>(us) * 1e3)};
}

gvsp::Frame upperHalf(gvsp::Frame frame) {
  frame.height_px /= 2;
  frame.picture.pieces = frame.picture.piecesOf(0, frame.picture.bytes() / 2);
  return frame;
}

}  // namespace

Camera::Camera(const Identity& identity, int stream_fd, RigContext& context)
    : identity_(identity),
      context_(context),
      stream_fd_(stream_fd),
      registers_(identity, context.max_packet_bytes, context.xml),
      sender_(stream_fd),
      source_(context.scene, identity.number),
      clock_(clockErrorPpm(identity.number)),
      wire_faults_(context.loss, identity.number + 1) {
  showLinkSpeed();
}

void Camera::powerOn() {
  stopAcquisition();
  control_.release();
  registers_ = Registers(identity_, context_.max_packet_bytes, context_.xml);
  last_block_id_ = 0;
  showLinkSpeed();
}

gvcp::Status Camera::startAcquisition(rt::Timestamp now) {
  if (acquiring_) return gvcp::Status::kSuccess;
  history_ = {};
  context_.scene.onAcquisition();
  source_.prepare({.sensor = identity_.sensor,
                   .offset_x_px = registers_.get(reg::kOffsetX),
                   .offset_y_px = registers_.get(reg::kOffsetY),
                   .size = {registers_.get(reg::kWidth), registers_.get(reg::kHeight)},
                   .pixel_format = registers_.get(reg::kPixelFormat)});
  const auto mode = static_cast<AcquisitionMode>(registers_.get(reg::kAcquisitionMode));
  single_frame_ = mode == AcquisitionMode::kSingleFrame;
  acquiring_ = true;
  stopped_by_.reset();
  own_triggers_ = 0;
  next_free_run_ = now;
  return gvcp::Status::kSuccess;
}

void Camera::stopAcquisition() {
  acquiring_ = false;
  exposure_.reset();
  exposure_fault_.reset();
  if (transfer_) ++context_.counters.frames_cut_short;
  transfer_.reset();
}

void Camera::onLine1(bool rising, rt::Timestamp edge, std::uint64_t trigger_number) {
  const auto activation = static_cast<TriggerActivation>(registers_.get(reg::kTriggerActivation));
  const auto source = static_cast<TriggerSource>(registers_.get(reg::kTriggerSource));
  if (source != TriggerSource::kLine1) return;
  if (rising != (activation == TriggerActivation::kRisingEdge)) return;
  trigger(edge, trigger_number, identity_.opto_delay);
}

void Camera::triggerOwn(TriggerSource source, rt::Timestamp now) {
  if (static_cast<TriggerSource>(registers_.get(reg::kTriggerSource)) != source) return;
  trigger(now, ++own_triggers_, rt::Nanoseconds{0});
}

void Camera::trigger(rt::Timestamp edge, std::uint64_t number, rt::Nanoseconds input_delay) {
  if (!acquiring_ && stopped_by_) return note(*stopped_by_, number);
  if (!acquiring_ || registers_.get(reg::kTriggerMode) == 0) return;
  if (const auto fault = faults_.swallowEdge()) return note(*fault, number);
  const ExposureTiming timing{
      input_delay + fromMicroseconds(registers_.getFloat(reg::kTriggerDelay)),
      fromMicroseconds(registers_.getFloat(reg::kExposureTime))};
  // A frame that a fault holds back waits outside the camera.
  const auto link_free_at =
      transfer_ ? transfer_->pacing.scheduledEnd() - transfer_->held : rt::Timestamp{};
  const auto exposure = tryExpose(number, edge, timing, exposure_.has_value(), link_free_at);
  if (exposure) {
    exposure_ = exposure;
  } else if (const auto fault = busyBecause()) {
    note(*fault, number);
  } else {
    ++context_.counters.overtriggers;
  }
}

LinkTiming Camera::linkTiming() const {
  return {.bits_per_second = linkBitsPerSecond(),
          .packet_bytes = registers_.get(reg::kStreamPacketSize) & kPacketSizeMask,
          .packet_delay = rt::Nanoseconds{registers_.get(reg::kStreamPacketDelay)}};
}

/// As fast as the frame rate, the exposure and the link allow, whichever is slowest.
rt::Nanoseconds Camera::freeRunPeriod() const {
  const LinkTiming link = linkTiming();
  const std::uint32_t per_packet = link.packet_bytes - gvsp::kPacketOverheadBytes;
  const std::uint32_t bytes = registers_.get(reg::kWidth) * registers_.get(reg::kHeight);
  auto period = link.perPacket() * ((bytes + per_packet - 1) / per_packet + 2);
  period = std::max(period, fromMicroseconds(registers_.getFloat(reg::kExposureTime)));
  if (registers_.get(reg::kFrameRateEnable) != 0) {
    period = std::max(period, fromMicroseconds(1e6f / registers_.getFloat(reg::kFrameRate)));
  }
  return period;
}

rt::Timestamp Camera::nextDeadline() const {
  auto deadline = rt::Timestamp::max();
  if (control_.isHeld()) {
    deadline = control_.lastHeard() +
               std::chrono::milliseconds(registers_.get(reg::kHeartbeatTimeout)) +
               rt::Nanoseconds{1};
  }
  if (transfer_) deadline = std::min(deadline, std::max(transfer_->pacing.next().at, retry_at_));
  if (exposure_ && !transfer_) deadline = std::min(deadline, exposure_->end);
  if (acquiring_ && !faults_.isFrozen() && !exposure_ && registers_.get(reg::kTriggerMode) == 0) {
    deadline = std::min(deadline, next_free_run_);
  }
  if (wantsExtraExposure()) deadline = rt::Timestamp{};
  return deadline;
}

bool Camera::wantsExtraExposure() const {
  return faults_.wantsExtraFrame() && acquiring_ && !faults_.isFrozen() && !exposure_ && !transfer_;
}

void Camera::advance(rt::Timestamp now) {
  if (control_.expire(now, std::chrono::milliseconds(registers_.get(reg::kHeartbeatTimeout)))) {
    if (faults_.isDark(now)) stopBecause(faults_.darkBecause());
    stopAcquisition();
  }
  if (wantsExtraExposure()) {
    faults_.extraFrameTaken();
    exposure_fault_ = Fault::kExtraFrame;
    exposure_ =
        Exposure{0, now, now, now + fromMicroseconds(registers_.getFloat(reg::kExposureTime))};
  }
  if (acquiring_ && !faults_.isFrozen() && !exposure_ && registers_.get(reg::kTriggerMode) == 0 &&
      now >= next_free_run_) {
    const auto exposure = fromMicroseconds(registers_.getFloat(reg::kExposureTime));
    exposure_ =
        Exposure{++own_triggers_, next_free_run_, next_free_run_, next_free_run_ + exposure};
    next_free_run_ += freeRunPeriod();
    // A stalled emulator goes on from now; it does not fire a burst of stale exposures.
    if (next_free_run_ < now) next_free_run_ = now;
  }
  if (exposure_ && !transfer_ && now >= exposure_->end) startTransfer();
  if (transfer_ && now >= retry_at_) sendDue(now);
}

void Camera::startTransfer() {
  const Exposure exposure = *exposure_;
  auto fault = std::exchange(exposure_fault_, std::nullopt);
  exposure_.reset();
  if (registers_.get(reg::kStreamPort) == 0) return;  // no stream is open
  const std::uint32_t slot = next_slot_;
  next_slot_ = (next_slot_ + 1) % kFrameHistory;
  last_block_id_ = last_block_id_ == 0xffff ? 1 : static_cast<std::uint16_t>(last_block_id_ + 1);

  const LinkTiming link = linkTiming();
  gvsp::Frame& frame = history_[slot];
  frame = {.block_id = last_block_id_,
           .timestamp = clockTicks(exposure.start),
           .width_px = registers_.get(reg::kWidth),
           .height_px = registers_.get(reg::kHeight),
           .offset_x_px = registers_.get(reg::kOffsetX),
           .offset_y_px = registers_.get(reg::kOffsetY),
           .pixel_format = registers_.get(reg::kPixelFormat),
           .payload_per_packet = link.packet_bytes - gvsp::kPacketOverheadBytes,
           .picture = source_.expose(exposure.trigger, slot)};
  if (faults_.sendsWrongSize()) frame = upperHalf(frame);
  const auto ready = std::max(exposure.end, link_free_at_);
  if (ready > exposure.end && !fault) fault = link_fault_;
  const auto held = faults_.takeHold();
  if (held > rt::Nanoseconds{0}) fault = Fault::kLateLeader;
  // Two messages together: their packets wake the receiver once, as a network card's coalesced
  // interrupt does, and Pacing bounds the time they span.
  transfer_.emplace(
      Transfer{.slot = slot,
               .pacing = Pacing(ready + held, link, frame.packetCount(),
                                2 * PacketSender::packetsPerMessage(frame.payload_per_packet)),
               .record = {.camera = identity_.number,
                          .frame_id = frame.block_id,
                          .trigger = exposure.trigger,
                          .trigger_edge = exposure.edge,
                          .exposure_end = exposure.end,
                          .first_packet = {},
                          .last_packet = {}},
               .held = ready + held - exposure.end,
               .fault = fault});
  link_free_at_ = transfer_->pacing.scheduledEnd();
  link_fault_ = fault;
}

PacketSender::Outcome Camera::put(const Pacing::Due& due, rt::Timestamp now) {
  PacketSender::Outcome outcome{.packets = due.count, .lost_on_purpose = due.count};
  if (!faults_.isDark(now)) {
    outcome =
        sender_.send(destination(), history_[transfer_->slot], due.first, due.count, wire_faults_);
  }
  context_.counters.packets_lost_on_purpose += outcome.lost_on_purpose;
  context_.counters.packets_doubled += outcome.doubled;
  context_.counters.packets_overtaken += outcome.overtaken;
  context_.counters.bytes_sent += outcome.bytes;
  return outcome;
}

void Camera::sendDue(rt::Timestamp now) {
  while (!transfer_->pacing.done()) {
    Pacing::Due due = transfer_->pacing.next();
    if (due.at > now) return;
    // So that the leader, which leaves alone, can be overtaken too.
    if (wire_faults_.rearranges() && due.first == 0) due.count = 2;
    const rt::Timestamp at = rt::now();
    const auto outcome = put(due, at);
    transfer_->packets_lost += outcome.lost_on_purpose;
    std::uint32_t settled = outcome.packets;
    if (outcome.os_errno == EAGAIN || outcome.os_errno == ENOBUFS) {
      retry_at_ = at + kRetryAfter;  // the rest stays due: it counts as late, never as sent
    } else if (outcome.os_errno != 0) {
      context_.counters.send_failures += due.count - outcome.packets;
      context_.counters.last_send_errno = outcome.os_errno;
      settled = due.count;
    }
    if (due.first == 0 && settled > 0) transfer_->record.first_packet = at;
    if (settled > 0) {
      transfer_->record.last_packet = at;
      transfer_->pacing.advance(settled);
    }
    if (settled == due.count) context_.lateness.add(at - due.at);
    if (settled < due.count) return;
  }
  finishTransfer();
}

void Camera::finishTransfer() {
  const SentFrame& frame = transfer_->record;
  const std::uint32_t lost = transfer_->packets_lost;
  if (lost < history_[transfer_->slot].packetCount()) {
    ++context_.counters.frames_sent;
    if (context_.wire_log != nullptr) context_.wire_log->add(frame);
  }
  if (lost > 0) note(lossBecause(frame.last_packet), frame.trigger, frame.frame_id, lost);
  if (transfer_->fault) note(*transfer_->fault, frame.trigger, frame.frame_id);
  transfer_.reset();
  if (single_frame_) stopAcquisition();
}

/// The camera's own, unless PTP holds it to the master's time.
std::uint64_t Camera::clockTicks(rt::Timestamp at) const {
  if (registers_.get(reg::kPtpEnable) == 0) return clock_.ticks(at);
  const auto since = at - rt::now();
  const auto master = std::chrono::system_clock::now() + since;
  return static_cast<std::uint64_t>(master.time_since_epoch().count());
}

}  // namespace emulator

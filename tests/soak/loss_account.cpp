#include "tests/soak/loss_account.h"

#include <algorithm>
#include <array>
#include <utility>

namespace soak {
namespace {

/// GigE Vision's 16 bit block ids run 1 to 65535; the trace counts on.
std::uint64_t onWire(std::uint64_t frame_id) {
  constexpr std::uint64_t kLast = 65535;
  return frame_id == 0 ? 0 : (frame_id - 1) % kLast + 1;
}

}  // namespace

std::string_view nameOf(LossCause cause) {
  constexpr std::array<std::string_view, kLossCauses> kNames = {
      "not sent", "late edge", "never came", "incomplete", "held up", "wrong size", "unattributed"};
  return kNames[static_cast<std::size_t>(cause)];
}

void LossAccount::triggerFired(const appliance::TriggerRecord& trigger) {
  if (!first_edge_) first_edge_ = trigger.trigger_edge_before;
  triggers_.push_back(trigger);
  trace_passed_ = std::max(trace_passed_, trigger.trigger_edge_before);
  judgePassed();
}

void LossAccount::frameArrived(const appliance::FrameRecord& frame) {
  if (frame.camera >= cameras_.size()) return;
  Camera& camera = cameras_[frame.camera];
  const Arrived arrived{frame.trigger, onWire(frame.frame_id), frame.status, frame.first_packet};
  (frame.trigger != 0 ? camera.stored : camera.refused).push_back(arrived);
}

void LossAccount::frameSent(const appliance::SentFrame& frame) {
  if (frame.camera >= cameras_.size()) return;
  cameras_[frame.camera].sent.push_back(frame);
  wire_passed_ = std::max(wire_passed_, frame.first_packet);
  judgePassed();
}

void LossAccount::judgePassed() {
  const rt::Timestamp passed = std::min(trace_passed_, wire_passed_);
  while (!triggers_.empty() && triggers_.front().trigger_edge_before + kLongestWay < passed) {
    judge(triggers_.front());
    triggers_.pop_front();
  }
}

void LossAccount::finish(rt::Timestamp last_edge) {
  for (const appliance::TriggerRecord& trigger : triggers_) {
    if (trigger.trigger_edge_before <= last_edge) judge(trigger);
  }
  triggers_.clear();
}

void LossAccount::judge(const appliance::TriggerRecord& trigger) {
  const rt::Timestamp edge = trigger.trigger_edge_before;
  const bool settled = edge >= *first_edge_ + kSettling;
  if (settled) ++triggers_judged_;
  const rt::Nanoseconds lateness = edge - trigger.deadline;
  const bool late = std::max(lateness, std::exchange(last_lateness_, lateness)) >= kLate;
  for (std::uint32_t i = 0; i < cameras_.size(); ++i) {
    Camera& camera = cameras_[i];
    const auto sent = sentFor(camera, trigger);
    const auto stored = storedFor(camera, trigger.trigger);
    if (stored) {
      if ((!sent || sent->frame_id != *stored) && wasTakenElsewhere(camera, trigger, *stored)) {
        misattributed_.push_back({i, trigger.trigger, edge});
      }
      if (settled) ++frames_stored_;
      continue;
    }
    if (!settled) {
      ++lost_while_settling_;
      continue;
    }
    const LossCause not_sent = late ? LossCause::kLateEdge : LossCause::kNotSent;
    lost_.push_back({i, sent ? causeOf(camera, trigger, *sent) : not_sent, trigger.trigger, edge});
  }
}

/// The stamp that the camera saw on the wire was taken between the trace's two instants. Frames
/// that no edge started pass by.
std::optional<appliance::SentFrame> LossAccount::sentFor(Camera& camera,
                                                         const appliance::TriggerRecord& trigger) {
  while (!camera.sent.empty() && camera.sent.front().trigger_edge < trigger.trigger_edge_before) {
    pass(camera);
  }
  if (camera.sent.empty() || camera.sent.front().trigger_edge > trigger.trigger_edge_after) {
    return std::nullopt;
  }
  const appliance::SentFrame sent = camera.sent.front();
  pass(camera);
  return sent;
}

void LossAccount::pass(Camera& camera) {
  constexpr std::size_t kKept = 64;
  camera.passed.push_back(camera.sent.front());
  camera.sent.pop_front();
  if (camera.passed.size() > kKept) camera.passed.pop_front();
}

/// A frame that the wire log does not know was cut off there and completed by resends: nothing
/// speaks against it.
bool LossAccount::wasTakenElsewhere(const Camera& camera, const appliance::TriggerRecord& trigger,
                                    std::uint64_t wire_id) {
  for (const auto* frames : {&camera.passed, &camera.sent}) {
    const auto found = std::ranges::find(*frames, wire_id, &appliance::SentFrame::frame_id);
    if (found == frames->end()) continue;
    return found->trigger_edge < trigger.trigger_edge_before - kSameMoment ||
           found->trigger_edge > trigger.trigger_edge_after + kSameMoment;
  }
  return false;
}

std::optional<std::uint64_t> LossAccount::storedFor(Camera& camera, std::uint64_t trigger) {
  while (!camera.stored.empty() && camera.stored.front().trigger < trigger) {
    camera.stored.pop_front();
  }
  if (camera.stored.empty() || camera.stored.front().trigger != trigger) return std::nullopt;
  return camera.stored.front().wire_id;
}

LossCause LossAccount::causeOf(Camera& camera, const appliance::TriggerRecord& trigger,
                               const appliance::SentFrame& sent) const {
  auto& refused = camera.refused;
  while (!refused.empty() && refused.front().at < trigger.trigger_edge_before) refused.pop_front();
  const auto found = std::ranges::find(refused, sent.frame_id, &Arrived::wire_id);
  if (found == refused.end()) return LossCause::kNeverCame;
  switch (found->status) {
    case hal::FrameStatus::kIncomplete:
      return sent.last_packet - sent.first_packet >= held_up_ ? LossCause::kHeldUp
                                                              : LossCause::kIncomplete;
    case hal::FrameStatus::kWrongSize:
      return LossCause::kWrongSize;
    default:
      return LossCause::kUnattributed;
  }
}

}  // namespace soak

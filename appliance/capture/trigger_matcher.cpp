#include "appliance/capture/trigger_matcher.h"

namespace appliance {
namespace {

bool hasClock(const FrameEvidence& frame) RT_SAFE {
  return frame.camera_clock != rt::Nanoseconds{0};
}

}  // namespace

std::optional<std::uint64_t> TriggerMatcher::clockFits(const Belief& belief,
                                                       const FrameEvidence& frame,
                                                       const EdgeBoard& edges) const RT_SAFE {
  const auto trigger =
      Association::edgeMaybeNear(belief.clock_zero + frame.camera_clock, tolerance_, edges);
  if (!trigger || *trigger <= belief.trigger) return std::nullopt;
  if (!association_.canArrive(edges.edge(*trigger), frame.arrival)) return std::nullopt;
  // A camera that counts from one again was restarted: its clock may be another one, too.
  if (frame.frame_id <= belief.frame_id) return std::nullopt;
  // Every frame has a trigger of its own.
  if (*trigger - belief.trigger < frame.frame_id - belief.frame_id) return std::nullopt;
  return trigger;
}

std::optional<std::uint64_t> TriggerMatcher::countFits(const Belief& belief,
                                                       const FrameEvidence& frame,
                                                       const EdgeBoard& edges) const RT_SAFE {
  const auto trigger = association_.triggerOf(frame.arrival, edges);
  if (!trigger || *trigger <= belief.trigger) return std::nullopt;
  if (*trigger - belief.trigger != frame.frame_id - belief.frame_id) return std::nullopt;
  return trigger;
}

std::optional<std::uint64_t> TriggerMatcher::fits(const Belief& belief, const FrameEvidence& frame,
                                                  const EdgeBoard& edges) const RT_SAFE {
  const bool forgotten = frame.arrival - belief.arrival > forgotten_after_;
  if (belief.agreeing == 0 || forgotten) return std::nullopt;
  return hasClock(frame) ? clockFits(belief, frame, edges) : countFits(belief, frame, edges);
}

MatchedTrigger TriggerMatcher::match(const FrameEvidence& frame, const EdgeBoard& edges) RT_SAFE {
  using enum MatchedTrigger::Why;
  if (association_.pace() == CameraPace::kFreeRunning) {
    const auto nearest = association_.triggerOf(frame.arrival, edges);
    return nearest ? MatchedTrigger{kMatched, *nearest} : MatchedTrigger{kNoEdge};
  }
  const auto trigger = fits(settled_, frame, edges);
  if (trigger && (!doubted_ || association_.triggerOf(frame.arrival, edges) == trigger)) {
    // Half of the difference: that follows the clock's drift and halves the jitter of the edges.
    // As far as the edge itself is uncertain, a difference says nothing about the clock.
    const rt::Timestamp zero = edges.edge(*trigger) - frame.camera_clock;
    const rt::Nanoseconds off = zero - settled_.clock_zero;
    const rt::Nanoseconds unknown = edges.uncertainty(*trigger);
    settled_ = {.agreeing = kAgreeing,
                .clock_zero = settled_.clock_zero + (off - std::clamp(off, -unknown, unknown)) / 2,
                .trigger = *trigger,
                .frame_id = frame.frame_id,
                .arrival = frame.arrival};
    candidate_ = {};
    doubted_ = false;
    return {kMatched, *trigger};
  }
  return relearn(frame, edges, trigger.has_value());
}

/// A frame that does not fit what was learned: the first, second or third for something new.
MatchedTrigger TriggerMatcher::relearn(const FrameEvidence& frame, const EdgeBoard& edges,
                                       bool possible) RT_SAFE {
  using enum MatchedTrigger::Why;
  const bool was_settled = settled_.agreeing != 0;
  bool between_edges = false;
  doubted_ = was_settled;
  if (was_settled && hasClock(frame) && !possible) {
    between_edges =
        !Association::edgeMaybeNear(settled_.clock_zero + frame.camera_clock, tolerance_, edges);
    if (between_edges) {
      ++settled_.frame_id;  // a frame that nothing asked for has an id and no trigger
    } else {
      settled_ = {};  // it leads to a trigger that is impossible: it is wrong
    }
  }

  const auto agreed = fits(candidate_, frame, edges);
  const auto trigger = agreed ? agreed : association_.triggerOf(frame.arrival, edges);
  if (!trigger) {
    candidate_ = {};
    return {kNoEdge};
  }
  candidate_ = {.agreeing = agreed ? candidate_.agreeing + 1 : 1,
                .clock_zero = edges.edge(*trigger) - frame.camera_clock,
                .trigger = *trigger,
                .frame_id = frame.frame_id,
                .arrival = frame.arrival};
  // Nearest to the first edge: it can be no other trigger's frame, however many edges have left
  // until this frame was read.
  const bool only_one = !was_settled && *trigger == 1;
  if (candidate_.agreeing < kAgreeing && !only_one) {
    return {between_edges ? kNoEdge : kUnsettled};
  }
  settled_ = candidate_;
  candidate_ = {};
  doubted_ = false;
  return {kMatched, *trigger};
}

}  // namespace appliance

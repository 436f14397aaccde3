#include "appliance/capture/frame_namer.h"

namespace appliance {
namespace {

bool hasClock(const FrameEvidence& frame) RT_SAFE {
  return frame.camera_clock != rt::Nanoseconds{0};
}

}  // namespace

std::optional<std::uint64_t> FrameNamer::clockFits(const Belief& belief, const FrameEvidence& frame,
                                                   const EdgeBoard& edges) const RT_SAFE {
  const auto trigger =
      Association::edgeMaybeNear(belief.clock_zero + frame.camera_clock, tolerance_, edges);
  if (!trigger || *trigger <= belief.trigger) return std::nullopt;
  if (!association_.canArrive(edges.edge(*trigger), frame.arrival)) return std::nullopt;
  // A camera that counts from one again was started anew: its clock too may be another one.
  if (frame.frame_id <= belief.frame_id) return std::nullopt;
  // Every frame has a trigger of its own.
  if (*trigger - belief.trigger < frame.frame_id - belief.frame_id) return std::nullopt;
  return trigger;
}

std::optional<std::uint64_t> FrameNamer::countFits(const Belief& belief, const FrameEvidence& frame,
                                                   const EdgeBoard& edges) const RT_SAFE {
  const auto trigger = association_.triggerOf(frame.arrival, edges);
  if (!trigger || *trigger <= belief.trigger) return std::nullopt;
  if (*trigger - belief.trigger != frame.frame_id - belief.frame_id) return std::nullopt;
  return trigger;
}

std::optional<std::uint64_t> FrameNamer::fits(const Belief& belief, const FrameEvidence& frame,
                                              const EdgeBoard& edges) const RT_SAFE {
  const bool forgotten = frame.arrival - belief.arrival > forgotten_after_;
  if (belief.agreeing == 0 || forgotten) return std::nullopt;
  return hasClock(frame) ? clockFits(belief, frame, edges) : countFits(belief, frame, edges);
}

FrameName FrameNamer::name(const FrameEvidence& frame, const EdgeBoard& edges) RT_SAFE {
  using enum FrameName::Why;
  if (association_.pace() == CameraPace::kFreeRunning) {
    const auto nearest = association_.triggerOf(frame.arrival, edges);
    return nearest ? FrameName{kNamed, *nearest} : FrameName{kNoEdge};
  }
  const auto trigger = fits(settled_, frame, edges);
  if (trigger && (!doubted_ || association_.triggerOf(frame.arrival, edges) == trigger)) {
    // Half of what the clock is off by now: follows its drift, halves an edge's own jitter. What
    // the edge itself is off says nothing about the clock.
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
    return {kNamed, *trigger};
  }
  return doubt(frame, edges, trigger.has_value());
}

/// A frame that does not fit what is known: a new belief's first, next or last witness.
FrameName FrameNamer::doubt(const FrameEvidence& frame, const EdgeBoard& edges,
                            bool possible) RT_SAFE {
  using enum FrameName::Why;
  const bool was_settled = settled_.agreeing != 0;
  bool between_edges = false;
  doubted_ = was_settled;
  if (was_settled && hasClock(frame) && !possible) {
    between_edges =
        !Association::edgeMaybeNear(settled_.clock_zero + frame.camera_clock, tolerance_, edges);
    if (between_edges) {
      ++settled_.frame_id;  // a frame that nothing asked for uses up an id, and no trigger
    } else {
      settled_ = {};  // it names a trigger that cannot be: so it is wrong
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
  // Seen nearest to the first edge there is no other whose frame it could be, however many edges
  // followed until somebody asked.
  const bool only_one = !was_settled && *trigger == 1;
  if (candidate_.agreeing < kAgreeing && !only_one) {
    return {between_edges ? kNoEdge : kUnsettled};
  }
  settled_ = candidate_;
  candidate_ = {};
  doubted_ = false;
  return {kNamed, *trigger};
}

}  // namespace appliance

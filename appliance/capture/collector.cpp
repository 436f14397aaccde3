#include "appliance/capture/collector.h"

#include <algorithm>

#include "appliance/capture/liveness.h"
#include "rt/section.h"

namespace appliance {
namespace {

/// A counter with a single writer needs no read-modify-write.
void count(std::atomic<std::uint64_t>& counter, std::uint64_t more = 1) RT_SAFE {
  counter.store(counter.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

}  // namespace

CollectorCounts& CollectorCounts::operator+=(const CollectorCounts& other) {
  stored += other.stored;
  missing += other.missing;
  away += other.away;
  no_slot += other.no_slot;
  incomplete += other.incomplete;
  wrong_size += other.wrong_size;
  no_edge += other.no_edge;
  repeated += other.repeated;
  unsettled += other.unsettled;
  unattributed += other.unattributed;
  last_stored = std::max(last_stored, other.last_stored);
  return *this;
}

/// The trigger under which to store the frame; 0 after counting why not.
std::uint64_t Collector::triggerOf(const hal::FrameArrival& arrival) RT_SAFE {
  switch (arrival.status) {
    case hal::FrameStatus::kComplete:
      break;
    case hal::FrameStatus::kIncomplete:
      count(incomplete_);
      return 0;
    case hal::FrameStatus::kWrongSize:
      count(wrong_size_);
      return 0;
    case hal::FrameStatus::kAborted:  // the end of a stream cuts a frame short: that is no loss
      return 0;
  }
  const MatchedTrigger name = matcher_.match({.arrival = arrival.first_packet,
                                              .camera_clock = arrival.camera_clock,
                                              .frame_id = arrival.frame_id},
                                             board_.edges);
  switch (name.why) {
    case MatchedTrigger::Why::kMatched:
      break;
    case MatchedTrigger::Why::kNoEdge:
      count(no_edge_);
      return 0;
    case MatchedTrigger::Why::kUnsettled:
      count(unsettled_);
      return 0;
  }
  if (name.trigger <= frames_.newest()) {
    count(repeated_);
    return 0;
  }
  return name.trigger;
}

/// The slot to fill next; the frame's own if it could not be stored.
std::uint32_t Collector::store(std::uint64_t trigger, const hal::FrameArrival& arrival) RT_SAFE {
  const std::uint64_t gap = trigger - frames_.newest() - 1;
  const std::uint32_t next =
      frames_.store(arrival.slot, {.trigger = trigger,
                                   .frame_id = arrival.frame_id,
                                   .trigger_edge = board_.edges.edge(trigger),
                                   .first_packet = arrival.first_packet,
                                   .last_packet = arrival.last_packet});
  if (next == arrival.slot) {
    count(no_slot_);
    return next;
  }
  count(restarted_ || gap >= kLostAfterTriggers ? away_ : missing_, gap);
  restarted_ = false;
  return next;
}

std::uint32_t Collector::onFrame(const hal::FrameArrival& arrival) RT_SAFE {
  const rt::ScopedRtSection rt_section;
  std::uint64_t trigger = triggerOf(arrival);

  std::uint32_t next = arrival.slot;  // a frame that is not stored is filled over
  if (trigger != 0) next = store(trigger, arrival);
  if (next == arrival.slot) trigger = 0;
  const rt::Timestamp frame_ready = rt::now();
  if (trigger != 0) {
    count(stored_);
    last_stored_ns_.store(rt::toNs(frame_ready), std::memory_order_relaxed);
    if (board_.shown_camera.load(std::memory_order_relaxed) == camera_) board_.wake_render.ring();
  }

  if (trace_ != nullptr) {
    trace_->record(FrameRecord{.camera = camera_,
                               .status = arrival.status,
                               .trigger = trigger,
                               .frame_id = arrival.frame_id,
                               .first_packet = arrival.first_packet,
                               .last_packet = arrival.last_packet,
                               .frame_ready = trigger != 0 ? frame_ready : rt::Timestamp{}});
  }
  if (trigger != 0 && board_.sets.arrived(trigger) && trace_ != nullptr) {
    trace_->record(SetRecord{.trigger = trigger, .set_complete = rt::now()});
  }
  return next;
}

CollectorCounts Collector::counts() const RT_SAFE {
  CollectorCounts counts{
      .stored = stored_.load(std::memory_order_relaxed),
      .missing = missing_.load(std::memory_order_relaxed),
      .away = away_.load(std::memory_order_relaxed),
      .no_slot = no_slot_.load(std::memory_order_relaxed),
      .incomplete = incomplete_.load(std::memory_order_relaxed),
      .wrong_size = wrong_size_.load(std::memory_order_relaxed),
      .no_edge = no_edge_.load(std::memory_order_relaxed),
      .repeated = repeated_.load(std::memory_order_relaxed),
      .unsettled = unsettled_.load(std::memory_order_relaxed),
      .last_stored = rt::fromNs(last_stored_ns_.load(std::memory_order_relaxed))};
  counts.unattributed = counts.no_edge + counts.repeated + counts.unsettled;
  return counts;
}

}  // namespace appliance

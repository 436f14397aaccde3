#include "appliance/capture/trigger_loop.h"

#include <cmath>

#include "rt/section.h"

namespace appliance {
namespace {

constexpr std::uint32_t kGenlockRecordEvery = 10;  // triggers

}  // namespace

void TriggerLoop::run(const std::stop_token& stop) noexcept {
  const rt::ScopedRtSection rt_section;
  rt::PeriodicLoop loop{
      rt::PeriodicSchedule{rt::now() + timing_.period, timing_.period, timing_.period / 5}};
  while (!stop.stop_requested()) {
    const auto tick = loop.wait();
    metrics_.missed.raiseTo(loop.schedule().missed());
    if (!tick) continue;
    pulse(tick->deadline);
    steer(loop.schedule());
  }
}

void TriggerLoop::pulse(rt::Timestamp deadline) noexcept {
  const auto edge = drive(true);
  if (!edge) return;
  // The board before anything else: the first packets are only an exposure away.
  const rt::Nanoseconds half = (edge->after - edge->before) / 2;
  edges_.post(++trigger_, edge->before + half, half);
  metrics_.edges.add();
  metrics_.lateness.add(edge->after - deadline);
  if (trace_ != nullptr) {
    trace_->record(TriggerRecord{.trigger = trigger_,
                                 .deadline = deadline,
                                 .trigger_edge_before = edge->before,
                                 .trigger_edge_after = edge->after});
  }
  rt::sleepUntil(edge->before + timing_.pulse_width);
  (void)drive(false);  // counted
}

rt::Result<hal::TriggerEdge> TriggerLoop::drive(bool active) noexcept {
  const auto edge = line_.setActive(active);
  failing_.store(!edge, std::memory_order_relaxed);
  if (!edge) metrics_.failed.add();
  return edge;
}

void TriggerLoop::steer(rt::PeriodicSchedule& schedule) noexcept {
  if (const auto input = genlock_board_.input.tryTake()) genlock_.take(*input);
  schedule.nudge(genlock_.step(schedule.deadline()));
  genlock_board_.status.store(genlock_.status());
  if (trace_ != nullptr) recordGenlock();
}

void TriggerLoop::recordGenlock() noexcept {
  const GenlockStatus& status = genlock_.status();
  const bool changed = status.state != recorded_.state || status.reason != recorded_.reason ||
                       status.hold_over != recorded_.hold_over;
  if (!changed && ++since_recorded_ < kGenlockRecordEvery) return;
  recorded_ = status;
  since_recorded_ = 0;
  trace_->record(
      GenlockRecord{.trigger = trigger_ + 1,
                    .state = status.state,
                    .reason = status.reason,
                    .hold_over = status.hold_over,
                    .vblanks_per_trigger = status.vblanks_per_trigger,
                    .phase_error = status.phase_error,
                    .lead = status.lead,
                    .vblank_period = rt::Nanoseconds(std::llround(status.vblank_period_ns)),
                    .unlocks = status.unlocks});
}

}  // namespace appliance

#include "appliance/capture/trigger_loop.h"

#include "rt/periodic_loop.h"
#include "rt/section.h"

namespace appliance {

void TriggerLoop::run(const std::stop_token& stop) noexcept {
  const rt::ScopedRtSection rt_section;
  rt::PeriodicLoop loop{
      rt::PeriodicSchedule{rt::now() + timing_.period, timing_.period, timing_.period / 5}};
  while (!stop.stop_requested()) {
    const auto tick = loop.wait();
    missed_.store(loop.schedule().missed(), std::memory_order_relaxed);
    if (tick) pulse(tick->deadline);
  }
}

void TriggerLoop::pulse(rt::Timestamp deadline) noexcept {
  const auto edge = line_.setActive(true);
  if (!edge) {
    failed_.store(failed() + 1, std::memory_order_relaxed);
    return;
  }
  // The board before anything else: the first packets are only an exposure away.
  edges_.post(++trigger_, edge->before);
  if (trace_ != nullptr) {
    trace_->record(TriggerRecord{.trigger = trigger_,
                                 .deadline = deadline,
                                 .trigger_edge_before = edge->before,
                                 .trigger_edge_after = edge->after});
  }
  rt::sleepUntil(edge->before + timing_.pulse_width);
  if (!line_.setActive(false)) failed_.store(failed() + 1, std::memory_order_relaxed);
}

}  // namespace appliance

#include "appliance/tools/genlock_report.h"

#include <algorithm>
#include <cmath>

namespace appliance {
namespace {

double ms(rt::Nanoseconds time) {
  return static_cast<double>(time.count()) / 1e6;
}

/// What the genlock said of a trigger; nothing where it had not said anything yet.
const GenlockRecord* recordOf(const Trace& trace, std::uint64_t trigger) {
  const auto after = std::ranges::upper_bound(trace.genlocks, trigger, {}, &GenlockRecord::trigger);
  return after == trace.genlocks.begin() ? nullptr : &*std::prev(after);
}

bool isLocked(const GenlockRecord* record) {
  return record != nullptr && record->state == GenlockState::kLocked;
}

void addTriggers(const Trace& trace, GenlockReport& report) {
  std::uint64_t locked = 0;
  for (const TriggerRecord& trigger : trace.triggers) {
    if (!isLocked(recordOf(trace, trigger.trigger))) continue;
    ++locked;
    if (!report.locked_after_s)
      report.locked_after_s =
          ms(trigger.trigger_edge_before - trace.triggers.front().trigger_edge_before) / 1e3;
  }
  if (!trace.triggers.empty())
    report.locked_share = static_cast<double>(locked) / static_cast<double>(trace.triggers.size());
}

void addRecords(const Trace& trace, GenlockReport& report) {
  std::vector<double> phase_error_us;
  std::vector<double> lead_ms;
  std::uint64_t unlocks = 0;
  for (const GenlockRecord& record : trace.genlocks) {
    if (record.state == GenlockState::kLocked) {
      phase_error_us.push_back(std::abs(ms(record.phase_error)) * 1e3);
      lead_ms.push_back(ms(record.lead));
    }
    if (record.unlocks > unlocks)
      report.unlocks.push_back({.trigger = record.trigger, .reason = record.reason});
    unlocks = record.unlocks;
  }
  report.phase_error_us = distributionOf(std::move(phase_error_us));
  report.lead_ms = distributionOf(std::move(lead_ms));
}

}  // namespace

GenlockReport computeGenlockReport(const Trace& trace, std::span<const FlippedTrigger> flipped) {
  GenlockReport report;
  if (!trace.genlocks.empty()) {
    const GenlockRecord& last = trace.genlocks.back();
    report.state = last.state;
    report.reason = last.reason;
    report.vblanks_per_trigger = last.vblanks_per_trigger;
  }
  addTriggers(trace, report);
  addRecords(trace, report);

  std::vector<double> locked_ms;
  std::vector<double> free_ms;
  for (const FlippedTrigger& one : flipped) {
    const GenlockRecord* record = recordOf(trace, one.trigger);
    if (!isLocked(record)) {
      free_ms.push_back(one.edge_to_flip_ms);
      continue;
    }
    locked_ms.push_back(one.edge_to_flip_ms);
    const double period_ms = ms(record->vblank_period);
    if (!(period_ms > 0)) continue;
    // One number of vblanks stands for the whole run, though lead may move a little.
    const double meant = std::ceil(report.lead_ms.p50 / period_ms);
    const double late = std::round((one.edge_to_flip_ms - ms(record->lead)) / period_ms);
    ++report.trigger_to_flip_vblanks[std::llround(meant + late)];
  }
  report.edge_to_flip_locked_ms = distributionOf(std::move(locked_ms));
  report.edge_to_flip_free_ms = distributionOf(std::move(free_ms));
  return report;
}

}  // namespace appliance

#include "appliance/machine/machine_part.h"

#include <cstddef>
#include <string>

#include "appliance/box/shared.h"
#include "appliance/config/durations.h"
#include "appliance/machine/machine_probe.h"
#include "appliance/machine/stall_log.h"

namespace appliance {
namespace {

// The trigger gives a pulse up that is this late; a shorter stall costs nothing.
constexpr int kStallOfPeriod = 5;

class MachinePart final : public Part {
 public:
  explicit MachinePart(const Shared& shared)
      : trace_(shared.traceProducer("machine")),
        throttle_(realTimeThrottle()),
        probe_(periodOf(shared.config.trigger.rate_hz) / kStallOfPeriod),
        metrics_(shared.metrics.group("machine")) {
    metrics_.addCount("stalls", [this] { return probe_.stalls(); });
    metrics_.addCount("stalls_dropped", [this] { return probe_.dropped(); });
  }

  [[nodiscard]] std::string_view name() const override { return "machine"; }

  /// A refused priority is no remark here: other threads' remarks already say it.
  [[nodiscard]] std::expected<void, std::string> start() override {
    if (!probe_.start()) return {};
    for (std::size_t i = 0; i < probe_.cpus(); ++i) {
      metrics_.add("wake_latency_cpu" + std::to_string(i), probe_.lateness(i));
    }
    return {};
  }

  void stop() override {
    probe_.stop();
    takeStalls();
  }

  void report(Status& status) const override {
    takeStalls();
    std::string line = log_.text(rt::now());
    if (!throttle_.empty()) line += (line.empty() ? "" : "; ") + throttle_;
    status.sections.push_back(
        {.key = "machine",
         .line = std::move(line),
         .values = {{"watched", probe_.watches()},
                    {"stalls", static_cast<std::int64_t>(log_.count())},
                    {"longest_stall_ms", static_cast<double>(log_.longest().count()) / 1e6}}});
  }

 private:
  void takeStalls() const {
    while (const auto stall = probe_.tryPop()) {
      log_.take(*stall);
      if (trace_ != nullptr)
        trace_->record(StallRecord{.cpu = stall->cpu, .begin = stall->begin, .end = stall->end});
    }
  }

  TraceProducer* const trace_;  // none: not traced
  const std::string throttle_;
  mutable MachineProbe probe_;  // report() takes what its rings hold
  mutable StallLog log_;
  MetricsGroup metrics_;
};

}  // namespace

MadePart makeMachinePart(const Shared& shared) {
  return std::make_unique<MachinePart>(shared);
}

}  // namespace appliance

#include "appliance/capture/trigger_part.h"

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "appliance/box/shared.h"
#include "appliance/capture/genlock_text.h"
#include "appliance/capture/loopback.h"
#include "appliance/capture/trigger_loop.h"
#include "appliance/capture/trigger_wiring.h"
#include "appliance/config/durations.h"

namespace appliance {
namespace {

TriggerTiming timingOf(const TriggerSettings& config) {
  return {.period = periodOf(config.rate_hz),
          .pulse_width = microseconds(config.pulse_width_us),
          .genlock = config.genlock,
          .genlock_margin = microseconds(config.genlock_margin_us)};
}

class TriggerPart final : public Part {
 public:
  /// @p loopback: none, or an input that reads @p line's edges.
  TriggerPart(const Shared& shared, std::unique_ptr<hal::TriggerLine> line,
              std::unique_ptr<hal::EdgeInput> loopback)
      : shared_(shared),
        period_(periodOf(shared.config.trigger.rate_hz)),
        line_(std::move(line)),
        loopback_(std::move(loopback)),
        loop_(timingOf(shared.config.trigger), *line_, shared.board.edges, shared.board.genlock,
              shared.traceProducer("trigger")),
        metrics_(shared.metrics.group("trigger")) {
    const TriggerMetrics& counted = loop_.metrics();
    metrics_.add("edges", counted.edges);
    metrics_.add("missed", counted.missed);
    metrics_.add("failed", counted.failed);
    metrics_.add("lateness", counted.lateness);
    if (loopback_ && shared.trace != nullptr)
      loopback_loop_.emplace(period_, *loopback_, shared.board.edges,
                             *shared.traceProducer("loopback"));
  }

  [[nodiscard]] std::string_view name() const override { return "trigger"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    if (loopback_loop_) {
      auto started =
          shared_.threads.startInto(loopback_thread_, "loopback", {},
                                    [this](const auto& stop) { loopback_loop_->run(stop); });
      if (!started) return started;
    }
    return shared_.threads.startInto(thread_, "trigger", shared_.config.realtime.trigger,
                                     [this](const auto& stop) { loop_.run(stop); });
  }

  void stop() override {
    if (thread_.joinable()) {
      thread_ = {};
      // Frames of the last triggers are still on the wire: the cameras stop after this.
      std::this_thread::sleep_for(2 * period_);
    }
    loopback_thread_ = {};
  }

  void report(Status& status) const override {
    status.triggers = shared_.board.edges.newest();
    status.genlock = shared_.board.genlock.status.load();
    const double rate_hz = shared_.config.trigger.rate_hz;
    status.genlock_text = genlockText(status.genlock, rate_hz);
    status.genlock_word = genlockPhrase(status.genlock, rate_hz).word;
    if (loop_.failing())
      status.degraded.push_back(remarkOf("trigger", phrase<Word::kTriggerGone>()));
  }

 private:
  const Shared& shared_;
  const rt::Nanoseconds period_;
  const std::unique_ptr<hal::TriggerLine> line_;
  const std::unique_ptr<hal::EdgeInput> loopback_;
  TriggerLoop loop_;
  MetricsGroup metrics_;
  std::optional<LoopbackLoop> loopback_loop_;
  rt::Thread loopback_thread_;
  rt::Thread thread_;
};

}  // namespace

MadePart makeTriggerPart(const Shared& shared) {
  const TriggerSettings& config = shared.config.trigger;
  auto line = openTriggerLine(config);
  if (!line) return std::unexpected(withId(Word::kTriggerRefused, line.error()));
  std::unique_ptr<hal::EdgeInput> loopback;
  if (!config.loopback_line.empty()) {
    auto opened = openLoopback(config, **line);
    if (!opened)
      shared.remarks.add("loopback", phrase<Word::kLoopbackMissing>(opened.error()));
    else
      loopback = std::move(*opened);
  }
  return std::make_unique<TriggerPart>(shared, std::move(*line), std::move(loopback));
}

}  // namespace appliance

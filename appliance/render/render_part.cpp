#include "appliance/render/render_part.h"

#include <string>
#include <utility>
#include <vector>

#include "appliance/box/shared.h"
#include "appliance/capture/camera_settings.h"
#include "appliance/config/durations.h"
#include "appliance/geometry/coverage_text.h"
#include "appliance/metrics/rate_meter.h"
#include "appliance/render/history_views.h"
#include "appliance/render/render_loop.h"
#include "appliance/status/screen_text.h"
#include "rt/ringed_thread.h"

namespace appliance {
namespace {

std::vector<rt::Nanoseconds> delayLadder(const DirectorSettings& config) {
  std::vector<rt::Nanoseconds> ladder;
  for (const double delay_s : config.delay_ladder_s) ladder.push_back(microseconds(delay_s * 1e6));
  return ladder;
}

RenderParts partsOf(const Shared& shared, StoredFrames& frames) {
  return {.rigs = shared.rigs,
          .frames = frames,
          .board = shared.board,
          .commands = shared.commands,
          .shown = shared.shown,
          .target = shared.target,
          .display = shared.display,
          .overlay = shared.overlay,
          .trace = shared.traceProducer("render"),
          .observer = shared.observer};
}

RenderParameters parametersOf(const Config& config) {
  return {.trigger_period = periodOf(config.trigger.rate_hz),
          .edge_to_exposure_middle =
              microseconds(commonDelay_us(config.cameras) + config.cameras.exposure_us / 2),
          .zoom = config.display.zoom,
          .director = {.sweep_views_per_second = config.director.sweep_views_per_s,
                       .delay_ladder = delayLadder(config.director),
                       .idle_home = microseconds(config.director.idle_home_s * 1e6)},
          .flicker_compensation = config.display.flicker_compensation};
}

std::string sourcePath(const Shared& shared) {
  std::string reason(shared.display.uploadReason());
  if (reason.empty()) reason = shared.history.notShared();
  return reason.empty() ? "dma-buf" : "upload: " + reason;
}

class RenderPart final : public Part {
 public:
  RenderPart(const Shared& shared, FrameReader& reader)
      : shared_(shared),
        renderer_(shared.display.renderer()),
        source_path_(sourcePath(shared)),
        frames_(reader, shared.board.edges),
        loop_(partsOf(shared, frames_), parametersOf(shared.config)),
        metrics_(shared.metrics.group("render")),
        thread_(shared.board.wake_render) {
    const RenderMetrics& counted = loop_.metrics();
    metrics_.add("pictures", counted.pictures);
    metrics_.add("sets_shown", counted.sets_shown);
    metrics_.add("skipped", counted.skipped);
    metrics_.add("flips", counted.flips);
    metrics_.add("flips_late", counted.flips_late);
    metrics_.add("draw", counted.draw);
    metrics_.add("ready_delay", counted.ready_delay);
    metrics_.add("commit_to_flip", counted.commit_to_flip);
  }

  [[nodiscard]] std::string_view name() const override { return "render"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    return shared_.threads.startInto(thread_.thread(), "render", shared_.config.realtime.render,
                                     [this](const auto& stop) { loop_.run(stop); });
  }

  void stop() override { thread_.stop(); }

  void report(Status& status) const override {
    const RenderStatus render = loop_.status();
    status.mode = render.shot.mode;
    status.view_wanted = render.shot.camera_wanted;
    status.view_shown = render.shot.camera_shown;
    status.delay_ms = static_cast<std::uint32_t>(render.shot.delay / std::chrono::milliseconds(1));
    const TargetPoint& target = render.target.point;
    status.target_m = {target.x_m, target.y_m, target.z_m};
    status.target_origin = nameOf(render.target.origin);
    status.shown_hz = shown_rate_.hz(rt::now(), loop_.metrics().sets_shown.value());
    status.pictures_skipped = loop_.metrics().skipped.value();
    status.renderer = renderer_;
    status.source_path = source_path_;
    status.screen = render.screen.state;
    const Phrase screen = screenPhrase(render.screen);
    status.screen_message = textOf(screen);
    status.screen_word = screen.word;
    reportViews(render, status);
    if (shared_.config.display.flicker_compensation)
      status.sections.push_back({.key = "light", .line = flickerText(render.flicker)});
  }

  [[nodiscard]] Answer handle(const Request& request) override {
    if (request.verb != "screen.release" && request.verb != "screen.take") return std::nullopt;
    loop_.setScreenReleased(request.verb == "screen.release");
    return std::expected<void, std::string>{};
  }

 private:
  void reportViews(const RenderStatus& render, Status& status) const {
    const RigPin rig = shared_.rigs.newest();
    if (const Phrase warning = coverWarning(*rig, render.cover_worst, render.cover_needed);
        !warning.empty())
      status.degraded.push_back(remarkOf("picture", warning));
    for (std::size_t i = 0; i < rig->cameras.size(); ++i) {
      if ((render.blind >> i & 1U) == 0) continue;
      status.degraded.push_back(remarkOf("view " + std::to_string(i + 1), blindWarning(*rig, i)));
    }
  }

  const Shared& shared_;
  const std::string renderer_;
  const std::string source_path_;
  HistoryViews frames_;
  mutable RenderLoop loop_;  // status() takes the newest of a hand-over
  MetricsGroup metrics_;
  mutable RateMeter shown_rate_;
  rt::RingedThread thread_;
};

static_assert(kRenderPins == RenderLoop::kPinsPerCamera);

}  // namespace

MadePart makeRenderPart(const Shared& shared) {
  auto reader = shared.history.openReader("render", kRenderPins);
  if (!reader) return std::unexpected(reader.error());
  return std::make_unique<RenderPart>(shared, **reader);
}

}  // namespace appliance

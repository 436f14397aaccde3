#include "appliance/appliance.h"

#include <algorithm>
#include <cstdio>
#include <thread>
#include <utility>

#include "appliance/capture/camera_settings.h"
#include "appliance/capture/camera_status.h"
#include "appliance/capture/genlock_text.h"
#include "appliance/capture/trigger_wiring.h"
#include "appliance/config/durations.h"
#include "appliance/depth/depth_settings.h"
#include "appliance/panel/panel_settings.h"
#include "appliance/trace/process_facts.h"
#include "hal/backends.h"

namespace appliance {
namespace {

using namespace std::chrono_literals;

// Producers of the trace: the loops, then one per camera.
constexpr std::size_t kTriggerTrace = 0;
constexpr std::size_t kRenderTrace = 1;
constexpr std::size_t kLoopbackTrace = 2;
constexpr std::size_t kFirstCameraTrace = 3;

constexpr std::uint32_t kFewestSets = 8;

std::string historyTooLarge(const HistoryLayout& layout, std::uint64_t available) {
  char line[256];
  std::snprintf(line, sizeof line,
                "memory: the history of %u sets takes %.1f GB, %.1f GB are available: lower "
                "history.sets, or free memory",
                layout.sets, static_cast<double>(layout.bytes()) * 1e-9,
                static_cast<double>(available) * 1e-9);
  return line;
}

std::vector<rt::Nanoseconds> delayLadder(const Config::Director& config) {
  std::vector<rt::Nanoseconds> ladder;
  for (const double delay_s : config.delay_ladder_s) ladder.push_back(microseconds(delay_s * 1e6));
  return ladder;
}

}  // namespace

Appliance::Appliance(const Config& config, const Rig& rig)
    : config_(config),
      rig_(rig),
      period_(periodOf(config.trigger.rate_hz)),
      board_(static_cast<std::uint32_t>(rig.cameras.size())) {}

std::expected<std::unique_ptr<Appliance>, std::string> Appliance::start(
    const Config& config, const Rig& rig, hal::Display& display, PictureObserver* observer,
    std::vector<std::string> degraded) {
  std::unique_ptr<Appliance> appliance(new Appliance(config, rig));
  appliance->degraded_ = std::move(degraded);
  auto done = appliance->makeHistory(display);
  if (done) done = appliance->openDevices();
  if (done) done = appliance->openTrace();
  if (done) {
    appliance->makeLoops(display, observer);
    done = appliance->startThreads(display);
  }
  if (!done) return std::unexpected(done.error());
  return appliance;
}

std::expected<void, std::string> Appliance::makeHistory(const hal::Display& display) {
  HistoryLayout layout{.frame_bytes = {},
                       .sets = config_.history.sets,
                       .in_flight = config_.history.in_flight,
                       .reserve = RenderLoop::kPinsPerCamera};
  for (const RigCamera& camera : rig_.cameras) {
    layout.frame_bytes.push_back(std::size_t{camera.width_px} * camera.height_px);
  }
  const std::uint64_t available = rt::availableMemoryBytes();
  const std::uint64_t margin = rt::LockedArena::kMarginBytes;
  const auto fitted = fitHistory(layout, available > margin ? available - margin : 0, kFewestSets);
  if (!fitted || (fitted->sets < layout.sets && !config_.history.size_down)) {
    return std::unexpected(historyTooLarge(layout, available));
  }
  if (fitted->sets < layout.sets) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "memory is short: the history holds %u sets (%.1f s) instead of %u", fitted->sets,
                  fitted->sets / config_.trigger.rate_hz, layout.sets);
    degraded_.emplace_back(line);
  }
  // Shared memory has its price (small pages, mostly): only for a renderer that reads it in place.
  std::string upload_reason(display.uploadReason());
  auto history = FrameHistory::create(
      *fitted, upload_reason.empty() ? HistorySharing::kShared : HistorySharing::kPrivate);
  if (!history) return std::unexpected(history.error());
  history_ = std::move(*history);
  auto reader = history_->openReader("render", RenderLoop::kPinsPerCamera);
  if (!reader) return std::unexpected(reader.error());
  shown_frames_ = std::make_unique<HistoryViews>(**reader, board_.edges);
  if (upload_reason.empty()) upload_reason = history_->notShared();
  source_path_ = upload_reason.empty() ? "dma-buf" : "upload: " + upload_reason;
  // The rest of the process after the arena: mlockall first would fault it in page by page.
  if (!config_.realtime.lock_memory) return {};
  const rt::MemoryLock lock = rt::lockMemory();
  if (lock.locked && history_->memory().report().locked) return {};
  std::string refused = lock.locked
                            ? "the frame history is not locked in memory: raise the memlock "
                              "limit (LimitMEMLOCK=infinity)"
                            : lock.message;
  if (config_.realtime.require) return std::unexpected(refused);
  degraded_.push_back(std::move(refused));
  return {};
}

std::expected<void, std::string> Appliance::openDevices() {
  auto line = openTriggerLine(config_.trigger);
  if (!line) return std::unexpected(line.error());
  trigger_line_ = std::move(*line);
  if (!config_.trigger.loopback_line.empty()) {
    auto loopback = openLoopback(config_.trigger, *trigger_line_);
    if (!loopback) degraded_.push_back(loopback.error() + "; the edges are not measured");
    if (loopback) loopback_ = std::move(*loopback);
  }
  openPanel();
  openDepthSensor();
  return {};
}

void Appliance::openPanel() {
  const Config::Panel& config = config_.panel;
  if (config.backend == "none") return;
  auto panel = hal::openButtonPanel(config.backend, panelSettings(config), degraded_);
  if (!panel) {
    degraded_.push_back(panel.error() + "; the box runs without its panel");
    return;
  }
  panel_ = std::move(*panel);
}

void Appliance::openDepthSensor() {
  const Config::DepthSensor& config = config_.depth_sensor;
  if (config.backend == "none") return;
  auto sensor = hal::openDepthSensor(config.backend, depthSensorSettings(config));
  if (!sensor) {
    degraded_.push_back(sensor.error() + "; the box runs without its depth sensor");
    return;
  }
  depth_loop_ = std::make_unique<DepthLoop>(std::move(*sensor), depth_board_);
}

std::expected<void, std::string> Appliance::openTrace() {
  if (config_.state.trace.empty()) return {};
  auto trace = TraceWriter::open(config_.state.trace, kFirstCameraTrace + rig_.cameras.size());
  if (!trace) return std::unexpected(trace.error());
  trace_ = std::move(*trace);
  return {};
}

void Appliance::makeLoops(hal::Display& display, PictureObserver* observer) {
  renderer_ = display.renderer();
  const auto producer = [&](std::size_t index) {
    return trace_ ? &trace_->producer(index) : nullptr;
  };
  cameras_ = std::make_unique<CameraArray>(config_, rig_, *history_, board_, trace_.get(),
                                           kFirstCameraTrace);
  trigger_loop_ = std::make_unique<TriggerLoop>(
      TriggerTiming{.period = period_,
                    .pulse_width = microseconds(config_.trigger.pulse_width_us),
                    .genlock = config_.trigger.genlock,
                    .genlock_margin = microseconds(config_.trigger.genlock_margin_us)},
      *trigger_line_, board_.edges, board_.genlock, producer(kTriggerTrace));
  if (loopback_ && trace_) {
    loopback_loop_ = std::make_unique<LoopbackLoop>(period_, *loopback_, board_.edges,
                                                    trace_->producer(kLoopbackTrace));
  }
  render_loop_ = std::make_unique<RenderLoop>(
      RenderParts{.rig = rig_,
                  .frames = *shown_frames_,
                  .board = board_,
                  .target = target_,
                  .display = display,
                  .trace = producer(kRenderTrace),
                  .observer = observer},
      RenderParameters{.trigger_period = period_,
                       .edge_to_exposure_middle = microseconds(commonDelay_us(config_.cameras) +
                                                               config_.cameras.exposure_us / 2),
                       .zoom = config_.display.zoom,
                       .pixel_format = config_.cameras.pixel_format,
                       .director = {.sweep_views_per_second = config_.director.sweep_views_per_s,
                                    .delay_ladder = delayLadder(config_.director)},
                       .flicker_compensation = config_.display.flicker_compensation});
}

std::expected<void, std::string> Appliance::startThreads(const hal::Display& display) {
  const auto& realtime = config_.realtime;
  auto started = startThread(render_thread_, "render", realtime.render,
                             [this](auto stop) { render_loop_->run(stop); });
  if (started && panel_) {
    panel_loop_ = std::make_unique<PanelLoop>(
        *panel_,
        [this](const PanelCommand& given) {
          (void)render_loop_->panelCommands().tryPush({given.command, given.cause});
          board_.wake_render.ring();
        },
        [this] { return render_loop_->mode(); });
    started = startThread(panel_thread_, "panel", realtime.panel,
                          [this](auto stop) { panel_loop_->run(stop); });
  }
  if (started && depth_loop_) {
    started =
        startThread(depth_thread_, "depth", {}, [this](auto stop) { depth_loop_->run(stop); });
  }
  if (started) started = cameras_->start();
  if (started && loopback_loop_) {
    started = startThread(loopback_thread_, "loopback", {},
                          [this](auto stop) { loopback_loop_->run(stop); });
  }
  // Cameras wait for their trigger now; the first edge is the last thing to come.
  if (started) {
    started = startThread(trigger_thread_, "trigger", realtime.trigger,
                          [this](auto stop) { trigger_loop_->run(stop); });
  }
  if (!started) {
    stopPipeline();
    return started;
  }
  if (trace_) trace_->begin(runRecord(display));
  return {};
}

std::expected<void, std::string> Appliance::startThread(rt::Thread& thread, const char* name,
                                                        const ThreadSchedule& how,
                                                        std::function<void(std::stop_token)> body) {
  auto started = rt::Thread::start(threadConfig(name, how), std::move(body));
  if (!started) {
    return std::unexpected(std::string("thread ") + name + " does not start: " +
                           started.error().where + ": check [realtime] in the configuration");
  }
  thread = std::move(*started);
  if (!thread.grant().complete()) {
    std::string refused = std::string("thread ") + name +
                          " runs without its real-time priority: grant CAP_SYS_NICE or "
                          "LimitRTPRIO=95";
    if (config_.realtime.require) return std::unexpected(refused);
    degraded_.push_back(std::move(refused));
  }
  return {};
}

Appliance::~Appliance() {
  stopPipeline();
}

void Appliance::stopPipeline() {
  if (trigger_thread_.joinable()) {
    trigger_thread_ = {};
    // Frames of the last triggers are still on the wire.
    std::this_thread::sleep_for(2 * period_);
  }
  if (cameras_) cameras_->stop();
  loopback_thread_ = {};
  panel_thread_ = {};
  depth_thread_ = {};
  if (render_thread_.joinable()) {
    render_thread_.requestStop();
    board_.wake_render.ring();
  }
  render_thread_ = {};
}

std::expected<void, std::string> Appliance::stop() {
  stopPipeline();
  return trace_ ? trace_->finish(summary()) : std::expected<void, std::string>{};
}

bool Appliance::command(const Command& command) {
  const bool taken = render_loop_->controlCommands().tryPush({command, rt::now()});
  board_.wake_render.ring();
  return taken;
}

/// What a person says of the target holds from the moment on screen on.
rt::Timestamp Appliance::shownExposure() const {
  const rt::Timestamp shown = render_loop_->status().exposure_middle;
  return shown == rt::Timestamp{} ? rt::now() : shown;
}

bool Appliance::setTarget(const std::array<double, 3>& target_m) {
  target_.setByHand({target_m[0], target_m[1], target_m[2]}, shownExposure());
  board_.wake_render.ring();
  return true;
}

void Appliance::releaseTarget() {
  target_.release(shownExposure());
  board_.wake_render.ring();
}

void Appliance::setScreenReleased(bool released) {
  render_loop_->setScreenReleased(released);
  board_.wake_render.ring();
}

Status Appliance::status() const {
  const RenderStatus render = render_loop_->status();
  const auto to_ms = [](rt::Nanoseconds t) { return static_cast<std::uint32_t>(t / 1'000'000ns); };
  Status status{
      .mode = render.shot.mode,
      .view_wanted = render.shot.camera_wanted,
      .view_shown = render.shot.camera_shown,
      .delay_ms = to_ms(render.shot.delay),
      .history_ms =
          to_ms(std::min<std::uint64_t>(board_.edges.newest(), history_->sets()) * period_),
      .target_m = {render.target.point.x_m, render.target.point.y_m, render.target.point.z_m},
      .target_origin = std::string(nameOf(render.target.origin)),
      .shown_hz = render.shown_hz,
      .triggers = board_.edges.newest(),
      .genlock = board_.genlock.status.load(),
      .degraded = degraded_,
      .renderer = renderer_,
      .screen = render.screen.state,
      .screen_message = render.screen.message.data(),
      .source_path = source_path_};
  if (trigger_loop_->failing()) {
    status.degraded.emplace_back(
        "trigger: pulses do not leave: the line's device is gone: check it, then restart");
  }
  if (panel_loop_ && panel_loop_->lost()) {
    status.degraded.emplace_back("panel: its GPIO chip is gone: check its plug, then restart");
  }
  if (depth_loop_) {
    const DepthReport depth = depth_loop_->report();
    status.depth_text = depthText(depth);
    if (std::string trouble = depthTrouble(depth); !trouble.empty())
      status.degraded.push_back(std::move(trouble));
  }
  for (std::string& remark : cameras_->remarks()) status.degraded.push_back(std::move(remark));
  for (std::string& remark : history_->remarks()) status.degraded.push_back(std::move(remark));
  status.genlock_text = genlockText(status.genlock, config_.trigger.rate_hz);
  if (config_.display.flicker_compensation) status.light_text = flickerText(render.flicker);
  status.cameras = cameras_->statuses();
  const CollectorCounts counts = cameras_->counts();
  status.frames_lost = counts.missing;
  status.frames_away = counts.away;
  status.frames_incomplete = counts.damaged();
  return status;
}

RunRecord Appliance::runRecord(const hal::Display& display) const {
  std::vector<std::string> degraded = degraded_;
  for (std::size_t i = 0; const CameraStatus& camera : cameras_->statuses()) {
    const std::string who = cameraTitle(i++, camera.name);
    if (!camera.reason.empty()) degraded.push_back(who + camera.reason);
  }
  const hal::DisplayMode mode = display.mode();
  const rt::ArenaReport& memory = history_->memory().report();
  return {.cameras = history_->cameras(),
          .width_px = rig_.cameras.front().width_px,
          .height_px = rig_.cameras.front().height_px,
          .pixel_format = hal::genicamName(config_.cameras.pixel_format),
          .trigger_hz = config_.trigger.rate_hz,
          .display_width_px = mode.width_px,
          .display_height_px = mode.height_px,
          .refresh_hz = mode.refresh_hz,
          .renderer = renderer_,
          .source_path = source_path_,
          .history_sets = history_->sets(),
          .memory_bytes = memory.bytes,
          .memory_locked = memory.locked,
          .threads = tracedThreads(),
          .degraded = std::move(degraded),
          .start = rt::now()};
}

SummaryRecord Appliance::summary() const {
  const CollectorCounts counts = cameras_->counts();
  return {.clean_stop = true,
          .stop = rt::now(),
          .cpu_seconds = cpuSeconds(),
          .memory_bytes = residentBytes(),
          .frames_lost = counts.missing,
          .frames_away = counts.away,
          .frames_incomplete = counts.damaged(),
          .frames_unattributed = counts.unattributed,
          .pictures_skipped = render_loop_->status().skipped};
}

}  // namespace appliance

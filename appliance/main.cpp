// kagamid: the appliance daemon. Reads top to bottom as the box starts: configuration, display,
// pipeline, control interface, then one event loop until a stop signal.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <expected>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <malloc.h>

#include "appliance/box/box.h"
#include "appliance/capture/trigger_wiring.h"
#include "appliance/config/config.h"
#include "appliance/journal/log.h"
#include "appliance/loop/event_loop.h"
#include "appliance/record/picture_recorder.h"
#include "appliance/service/box_service.h"
#include "appliance/site/site.h"
#include "appliance/site/site_light.h"
#include "appliance/version/version.h"
#include "ui-kms/draw_workers.h"
#include "ui-kms/kms_display.h"
#include "ui-kms/offscreen_display.h"

namespace {

using namespace appliance;

struct Options {
  std::string config_file = "/etc/kagami/kagamid.toml";
  std::vector<std::string> overrides;
  std::vector<double> target_m;  // empty: the rig's
  bool check_config = false;
  bool release_lines = false;
};

struct Screen {
  std::unique_ptr<hal::Display> display;
  ui::PictureSource* source = nullptr;  // the same object
};

std::vector<ui::SizePx> sourceSizes(const Rig& rig) {
  std::vector<ui::SizePx> sizes;
  for (const RigCamera& camera : rig.cameras) {
    const ui::SizePx size{camera.width_px, camera.height_px};
    if (std::ranges::find(sizes, size) == sizes.end()) sizes.push_back(size);
  }
  return sizes;
}

ui::RendererConfig rendererConfig(const DisplaySettings& config, const Rig& rig) {
  return {.width_px = config.width_px,
          .height_px = config.height_px,
          .rotation_deg = config.rotation_deg,
          .sources = sourceSizes(rig),
          .font_path = config.font,
          .software_threads = config.render_threads};
}

template <class Display>
Screen screenOf(std::unique_ptr<Display> display) {
  if (!display->textWarning().empty())
    log(LogLevel::kWarning, phrase<Word::kDisplayNote>(display->textWarning()));
  ui::PictureSource* source = display.get();
  return {.display = std::move(display), .source = source};
}

/// @p missing: why there is no screen, in one line; empty if the configuration asks for none.
std::expected<Screen, std::string> makeOffscreen(const DisplaySettings& config, const Rig& rig,
                                                 const std::string& missing) {
  hal::ScreenStatus status;
  if (!missing.empty()) {
    status.state = hal::ScreenState::kNoScreen;
    status.trouble = hal::ScreenTrouble::kNoDisplay;
    hal::putText(status.detail, missing);
  }
  auto display = ui::OffscreenDisplay::create(
      {.renderer = rendererConfig(config, rig), .refresh_hz = config.refresh_hz, .screen = status});
  if (!display) return std::unexpected(display.error());
  return screenOf(std::move(*display));
}

/// The box waits for a screen that is not connected yet. Without a graphics card it still captures,
/// stores and answers: decision 0011.
std::expected<Screen, std::string> makeScreen(const Config& config, const Rig& rig) {
  if (config.display.backend == "offscreen") return makeOffscreen(config.display, rig, "");
  if (config.display.backend != "kms")
    return std::unexpected(withId(phrase<Word::kDisplayBackend>(config.display.backend)));
  if (const auto mode = ui::kms::parseModeSpec(config.display.mode); !mode) {
    return std::unexpected(withId(phrase<Word::kDisplayMode>(mode.error())));
  }
  auto display = ui::KmsDisplay::create({.renderer = rendererConfig(config.display, rig),
                                         .refresh_hz = config.display.refresh_hz,
                                         .device = config.display.device,
                                         .mode = config.display.mode,
                                         .trigger_hz = config.trigger.rate_hz,
                                         .queue_depth = config.display.queue_depth});
  if (display) {
    log(LogLevel::kInfo, phrase<Word::kScreenFound>((*display)->description()));
    return screenOf(std::move(*display));
  }
  return makeOffscreen(config.display, rig, display.error());
}

bool scheduleDrawWorkers(const ThreadSchedule& how) {
  return ui::scheduleDrawWorkers(
      {.policy = how.policy, .priority = how.priority, .cpus = how.cpus});
}

/// Drives the lines inactive after a daemon was killed: the kernel leaves them at their last level.
std::expected<void, std::string> releaseLines(const Options& options) {
  const auto config = loadConfig(options.config_file, options.overrides);
  if (!config) return std::unexpected(config.error());
  if (const auto line = openTriggerLine(config->trigger); !line)
    return std::unexpected(line.error());
  return {};
}

/// For threads that did not stop: they still use what an orderly end would destroy.
void endAbruptly(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) logError(line);
  std::_Exit(EXIT_FAILURE);
}

/// Errors   One line; nothing is left running.
std::expected<void, std::string> run(const Site& site, EventLoop& loop) {
  const Config& config = site.config;
  const auto screen = makeScreen(config, site.rig);
  if (!screen) return std::unexpected(screen.error());
  hal::Display& display = *screen->display;

  std::unique_ptr<PictureRecorder> recorder;
  if (!config.record.directory.empty()) {
    auto made = PictureRecorder::create(config.record, display.mode(), *screen->source);
    if (!made) return std::unexpected(made.error());
    recorder = std::move(*made);
  }
  if (!scheduleDrawWorkers(config.realtime.draw)) {
    const Phrase plain = phrase<Word::kDrawPlain>();
    if (config.realtime.require) return std::unexpected(withId(plain));
    log(LogLevel::kWarning, plain);
  }
  auto running =
      Box::start(site, {.display = display, .observer = recorder.get(), .on_hang = endAbruptly});
  if (!running) return std::unexpected(running.error());
  for (const Phrase& line : lightLines(lightParameters(config, site.rig)))
    log(LogLevel::kInfo, line);
  const auto service =
      BoxService::start(loop, {.bus = config.control.bus, .name = config.control.name}, **running,
                        **running, (*running)->jobs(), (*running)->busObjects());
  if (!service) return std::unexpected(service.error());
  log(LogLevel::kInfo, phrase<Word::kRunning>(site.rig.cameras.size(), display.renderer(),
                                              (*running)->status().source_path));

  const auto served = (*service)->run();

  if (const auto stopped = (*running)->stop(); !stopped) return stopped;
  if (!served) return served;
  return recorder ? recorder->finish() : std::expected<void, std::string>{};
}

/// Always maps buffers above 128 KiB, so that freeing one returns it to the system. By default
/// glibc raises this threshold at the first large free(); every thread that opens a camera would
/// then keep that memory for good.
void returnLargeBuffers() {
  constexpr int kLargeBytes = 128 * 1024;
  static_cast<void>(mallopt(M_MMAP_THRESHOLD, kLargeBytes));
}

}  // namespace

int main(int argc, char** argv) {
  returnLargeBuffers();  // before any thread
  Options options;
  CLI::App app{"kagamid: fires the cameras, keeps the last seconds, shows the athlete"};
  app.add_option("--config", options.config_file, "Configuration file")->capture_default_str();
  app.add_option("--set", options.overrides, "Override a key: --set display.zoom=1.5")
      ->type_name("SECTION.KEY=VALUE");
  app.add_option("--target", options.target_m, "Point to show, rig frame, metres")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  app.add_flag("--check-config", options.check_config, "Check configuration and rig, then end");
  app.add_flag("--release-lines", options.release_lines,
               "Drive the trigger lines inactive, then end: for after a crash");
  app.set_version_flag("--version", std::string(version()));
  CLI11_PARSE(app, argc, argv);

  if (options.release_lines) {
    const auto released = releaseLines(options);
    if (!released) logError(released.error());
    return released ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  const auto loop = EventLoop::create();  // before any thread
  const auto listening = loop ? (*loop)->stopOnSignals() : std::expected<void, std::string>{};
  if (!loop || !listening) {
    logError(loop ? listening.error() : loop.error());
    return EXIT_FAILURE;
  }
  const auto site = loadSite(options.config_file, options.overrides, options.target_m);
  if (!site) {
    logError(site.error());
    return EXIT_FAILURE;
  }
  if (options.check_config) {
    for (const Phrase& remark : site->degraded) log(LogLevel::kWarning, remark);
    std::printf("%s: good; %s: %zu cameras\n", options.config_file.c_str(),
                site->config.rig.file.c_str(), site->rig.cameras.size());
    return EXIT_SUCCESS;
  }
  if (const auto ended = run(*site, **loop); !ended) {
    logError(ended.error());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

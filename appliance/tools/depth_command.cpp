#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "appliance/config/config.h"
#include "appliance/control/control_client.h"
#include "appliance/depth/depth_loop.h"
#include "appliance/depth/depth_record.h"
#include "appliance/depth/depth_settings.h"
#include "appliance/depth/depth_text.h"
#include "appliance/depth/lamp_finder.h"
#include "appliance/depth/latency.h"
#include "appliance/panel/panel_settings.h"
#include "appliance/tools/commands.h"
#include "appliance/tools/job_progress.h"
#include "appliance/tools/moved_folder.h"
#include "hal/backends.h"

namespace appliance {
namespace {

using namespace std::chrono_literals;

struct Options {
  std::string config = "/etc/kagami/kagamid.toml";
  std::vector<std::string> overrides;
  double seconds = 10;
  std::string lamp_log;
};

Config configOf(const Options& options) {
  auto config = loadConfig(options.config, options.overrides);
  if (!config) fail(config.error());
  if (config->depth_sensor.backend == "none")
    fail("no depth sensor is configured: set depth_sensor.backend, e.g. with --set");
  return *config;
}

std::unique_ptr<hal::DepthSensor> sensorOf(const DepthSettings& config) {
  auto sensor = hal::openDepthSensor(config.backend, config.device);
  if (!sensor) fail(sensor.error());
  return std::move(*sensor);
}

rt::Timestamp after(double seconds) {
  return rt::now() + rt::Nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

void watch(const Options& options) {
  const auto sensor = sensorOf(configOf(options).depth_sensor);
  DepthRecord record;
  std::string told;
  rt::Timestamp end = after(options.seconds);
  while (rt::now() < end) {
    if (const auto frame = sensor->waitFrame(100ms)) {
      if (record.frames() == 0) end = after(options.seconds);  // opening takes its time
      record.onFrame(*frame);
    }
    const hal::DepthStatus status = sensor->status();
    if (status.message != told && !status.message.empty())
      std::printf("%s\n", status.message.c_str());
    told = status.message;
    if (status.state == hal::DepthState::kEnded) break;
  }
  const hal::DepthStatus status = sensor->status();
  std::printf("sensor     %s\n%s", depthText({status, record.rate_hz()}).c_str(),
              recordText(record).c_str());
  std::printf("clock      %+.1f ppm against this machine's\n", status.drift_ppm);
  if (record.frames() == 0 || record.lost() > 0) throw CommandFailed();
}

/// The panel's first lamp, switched after 0.2 to 0.8 s each time.
class BlinkingLamp {
 public:
  explicit BlinkingLamp(const PanelSettings& config) {
    auto panel = hal::openButtonPanel(config.backend, config.device, notes_);
    if (!panel) {
      fail(panel.error() +
           ": the latency is measured with the lamp of a panel, or with "
           "--lamp-log");
    }
    panel_ = std::move(*panel);
  }
  /// Switches it if it is time.
  void turn() {
    if (rt::now() < next_) return;
    on_ = !on_;
    panel_->setLamp(hal::Lamp::kLive, on_);
    changes_.push_back({rt::now(), on_});
    next_ = rt::now() + 200ms + std::chrono::milliseconds(random_() % 600);
  }
  [[nodiscard]] const std::vector<LampChange>& changes() const { return changes_; }

 private:
  std::vector<std::string> notes_;
  std::unique_ptr<hal::ButtonPanel> panel_;
  std::mt19937 random_{1};
  rt::Timestamp next_;
  bool on_ = false;
  std::vector<LampChange> changes_;
};

std::vector<LampChange> readLampLog(const std::string& path) {
  std::ifstream in(path);
  if (!in) fail(path + ": cannot be read");
  std::vector<LampChange> changes;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::int64_t at_ns = 0;
    int on = 0;
    if (!(words >> at_ns >> on) || (on != 0 && on != 1) ||
        (!changes.empty() && rt::fromNs(at_ns) < changes.back().at)) {
      fail(path + ":" + std::to_string(number) + ": must be a rising instant in ns, and 0 or 1");
    }
    changes.push_back({rt::fromNs(at_ns), on == 1});
  }
  return changes;
}

void latency(const Options& options) {
  Config config = configOf(options);
  config.depth_sensor.device.latency = {};  // what is measured must not be applied already
  config.depth_sensor.device.colour = true;
  const auto sensor = sensorOf(config.depth_sensor);
  std::unique_ptr<BlinkingLamp> lamp;
  if (options.lamp_log.empty()) lamp = std::make_unique<BlinkingLamp>(config.panel);
  LampFinder finder;
  for (const rt::Timestamp end = after(options.seconds); rt::now() < end;) {
    if (lamp) lamp->turn();
    const auto frame = sensor->waitFrame(20ms);
    if (!frame || frame->colour_rgb.empty()) continue;
    if (frame->width_px < LampFinder::kColumns || frame->height_px < LampFinder::kRows) continue;
    finder.add(*frame);
  }
  const auto samples = finder.samples();
  if (samples.empty()) {
    const std::string message = sensor->status().message;
    fail(message.empty() ? "no colour picture came from the depth sensor" : message);
  }
  const auto measured =
      measureLatency(samples, lamp ? lamp->changes() : readLampLog(options.lamp_log));
  if (!measured) fail(measured.error());
  std::printf("latency_ms = %.1f    # %zu changes of the lamp, correlation %.3f\n",
              static_cast<double>(measured->latency.count()) * 1e-6, measured->changes,
              measured->correlation);
}

struct SnapshotOptions {
  std::filesystem::path out;  // empty: where kagamid wrote it
  std::uint32_t pairs = 1;
};

void snapshot(const ControlPlace& place, const SnapshotOptions& options) {
  if (!options.out.empty())
    if (const auto free = checkNewFolder(options.out); !free) fail(free.error());
  const HeldSignals signals;
  auto client = ControlClient::open(place.bus, place.name);
  if (!client) fail(client.error());
  const auto job = client->snapshotDepth(options.pairs);
  if (!job) fail(job.error());
  std::filesystem::path folder = followJob(*client, *job, signals);
  if (!options.out.empty()) {
    const auto moved = moveFolder(folder, options.out);
    if (!moved) fail(moved.error());
    if (!moved->empty()) std::fprintf(stderr, "kagami: %s\n", moved->c_str());
    folder = options.out;
  }
  std::printf("%s: %u pairs\n", folder.c_str(), options.pairs);
}

void addSnapshotCommand(CLI::App& depth, const ControlPlace& place) {
  const auto options = std::make_shared<SnapshotOptions>();
  CLI::App* command = depth.add_subcommand(
      "snapshot", "Write what the running box sees as a folder; Ctrl-C gives up");
  command->add_option("--out", options->out,
                      "a new folder; without it the snapshot stays in [state] directory");
  command
      ->add_option("--frames", options->pairs, "pairs of pictures: the newest, and those that come")
      ->check(CLI::Range(1U, 900U))
      ->capture_default_str();
  command->callback([&place, options] { snapshot(place, *options); });
}

}  // namespace

void addDepthCommand(CLI::App& kagami, const ControlPlace& place) {
  const auto options = std::make_shared<Options>();
  CLI::App* depth = kagami.add_subcommand(
      "depth", "Watch the depth sensor, measure its latency, keep what it sees");
  depth->require_subcommand(1);
  depth->footer(
      "For watch and latency kagamid must not run, because a sensor serves one program; snapshot "
      "asks the running kagamid.");
  addSnapshotCommand(*depth, place);
  const auto add = [&](const char* name, const char* what) {
    CLI::App* command = depth->add_subcommand(name, what);
    command->add_option("--config", options->config)->capture_default_str();
    command->add_option("--set", options->overrides, "section.key=value, as for kagamid")
        ->allow_extra_args(false);
    command->add_option("--seconds", options->seconds)
        ->check(CLI::Range(1.0, 86400.0))
        ->capture_default_str();
    return command;
  };
  add("watch", "How punctually pictures come; ends with 1 where some were lost")
      ->callback([options] { watch(*options); });
  CLI::App* measure = add("latency", "From exposure to arrival, by a lamp in the sensor's view");
  measure->add_option("--lamp-log", options->lamp_log,
                      "when the lamp changed, lines of nanoseconds and 0 or 1; without it the "
                      "panel's lamp blinks");
  measure->callback([options] { latency(*options); });
}

}  // namespace appliance

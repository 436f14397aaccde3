// kagami-depth: the process that runs OpenNI2 and its drivers for Kagami, and what else needs
// OpenNI2 itself: recordings.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "hal/openni/device.h"
#include "hal/openni/driver_stage.h"
#include "hal/openni/folder_writer.h"
#include "hal/openni/openni_sensor.h"
#include "hal/openni/wire.h"
#include "hal/openni/worker.h"

namespace hal::openni {
namespace {

using namespace std::chrono_literals;

constexpr int kSocket = 3;
constexpr const char* kStage = "KAGAMI_DEPTH_STAGE";

struct Options {
  DeviceRequest device;
  std::string drivers;
  std::string out;
  double seconds = 10;
  std::uint64_t pictures = 0;  ///< of a recording; 0: as many as come
  bool jpeg = false;
};

/// Starts this program again with the drivers of @p drivers; returns only if that fails.
std::string becomeStaged(const std::string& drivers, char** argv) {
  auto stage = DriverStage::make(drivers);
  if (!stage) return stage.error();
  ::setenv(kStage, stage->folder().c_str(), 1);
  ::setenv("LD_LIBRARY_PATH", stage->folder().c_str(), 1);
  // By its own name: that is what `ps` shows.
  std::error_code failed;
  ::execv(std::filesystem::read_symlink("/proc/self/exe", failed).c_str(), argv);
  return "depth sensor: kagami-depth cannot start itself again";
}

int work(const Options& options, const std::string& trouble) {
  const char* folder = std::getenv(kStage);
  if (trouble.empty())
    return runWorker(kSocket, options.device, DriverStage(folder == nullptr ? "" : folder));
  WireMessage fail{.kind = WireMessage::Kind::kFail};
  fail.setText(trouble);
  (void)send(kSocket, fail);
  return 1;
}

int say(const std::string& error) {
  std::fprintf(stderr, "kagami-depth: %s\n", error.c_str());
  return 1;
}

int record(const Options& options) {
  const char* folder = std::getenv(kStage);
  DriverStage stage(folder == nullptr ? "" : folder);
  if (auto started = Device::startLibrary(); !started) return say(started.error());
  auto device = Device::open(options.device);
  stage.remove();
  if (!device) return say(device.error());
  if (auto recording = (*device)->record(options.out); !recording) return say(recording.error());
  const rt::Timestamp end =
      rt::now() + rt::Nanoseconds(static_cast<std::int64_t>(options.seconds * 1e9));
  std::uint64_t pairs = 0;
  const auto all = [&] { return options.pictures > 0 && pairs >= options.pictures; };
  for (DevicePair pair; rt::now() < end && !all();) {
    const auto answer = (*device)->next(100ms, pair);
    if (answer == Device::Answer::kPair) ++pairs;
    if (answer == Device::Answer::kGone) return say("the sensor was unplugged");
  }
  std::printf("%s: %llu pictures\n", options.out.c_str(), static_cast<unsigned long long>(pairs));
  return pairs > 0 ? 0 : 1;
}

int list() {
  const char* folder = std::getenv(kStage);
  DriverStage stage(folder == nullptr ? "" : folder);
  if (auto started = Device::startLibrary(); !started) return say(started.error());
  for (const std::string& line : Device::list()) std::printf("%s\n", line.c_str());
  return 0;
}

int exportFolder(const Options& options) {
  auto sensor = OpenniSensor::open({.source = options.device.source,
                                    .drivers = options.drivers,
                                    .width_px = options.device.mode.width_px,
                                    .height_px = options.device.mode.height_px,
                                    .rate_hz = options.device.mode.rate_hz,
                                    .colour = options.device.colour,
                                    .latency = {},
                                    .repeat = false},
                                   {.play = Play::kEveryFrame});
  if (!sensor) return say(sensor.error());
  const rt::Timestamp end =
      rt::now() + rt::Nanoseconds(static_cast<std::int64_t>(options.seconds * 1e9));
  FolderWriter writer(options.out, options.jpeg ? ColourFile::kJpeg : ColourFile::kPng);
  while (rt::now() < end || options.device.source.ends_with(".oni")) {
    const auto frame = (*sensor)->waitFrame(1s);
    const DepthStatus status = (*sensor)->status();
    if (frame) {
      if (auto written = writer.write(*frame, status.name); !written) return say(written.error());
    } else if (status.state == DepthState::kEnded) {
      break;
    } else if (!status.message.empty()) {
      return say(status.message);
    }
  }
  std::printf("%s: %llu pictures\n", options.out.c_str(),
              static_cast<unsigned long long>(writer.written()));
  return writer.written() > 0 ? 0 : 1;
}

void addDevice(CLI::App& command, Options& options) {
  command.add_option("--source", options.device.source, "URI or .oni file; \"\": the first sensor");
  command.add_option("--drivers", options.drivers, "folder of OpenNI2 drivers; \"\": the system's");
  command.add_option("--width", options.device.mode.width_px)->capture_default_str();
  command.add_option("--height", options.device.mode.height_px)->capture_default_str();
  command.add_option("--rate", options.device.mode.rate_hz, "Hz")->capture_default_str();
  command.add_option("--colour", options.device.colour)->capture_default_str();
}

}  // namespace
}  // namespace hal::openni

int main(int argc, char** argv) {
  using namespace hal::openni;
  CLI::App app{"Depth sensors and recordings of them, through OpenNI2.", "kagami-depth"};
  app.require_subcommand(1);
  Options options;
  CLI::App* worker =
      app.add_subcommand("worker", "serve one sensor to the program that started this");
  addDevice(*worker, options);
  CLI::App* recorder = app.add_subcommand("record", "write what a sensor sees into an .oni file");
  addDevice(*recorder, options);
  recorder->add_option("file", options.out)->required();
  recorder->add_option("--seconds", options.seconds, "at most")->capture_default_str();
  recorder->add_option("--pictures", options.pictures, "at most; 0: no limit")
      ->capture_default_str();
  CLI::App* exporter = app.add_subcommand("export", "write a sensor or an .oni file as a folder");
  addDevice(*exporter, options);
  exporter->add_option("folder", options.out)->required();
  exporter->add_option("--seconds", options.seconds, "of a sensor")->capture_default_str();
  exporter->add_flag("--jpeg", options.jpeg, "smaller colour pictures, no longer exact");
  CLI::App* lister = app.add_subcommand("list", "the sensors that are plugged in");
  lister->add_option("--drivers", options.drivers, "folder of OpenNI2 drivers");
  CLI11_PARSE(app, argc, argv);
  // The exporter's worker stages its drivers itself.
  std::string trouble;
  if (!options.drivers.empty() && !exporter->parsed() &&
      std::getenv("KAGAMI_DEPTH_STAGE") == nullptr)
    trouble = becomeStaged(options.drivers, argv);
  if (worker->parsed()) return work(options, trouble);
  if (!trouble.empty()) return say(trouble);
  if (recorder->parsed()) return record(options);
  if (lister->parsed()) return list();
  return exportFolder(options);
}

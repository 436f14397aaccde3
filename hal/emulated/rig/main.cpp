/// kagami-emulator: the far side of the camera and trigger wires on a machine without them.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "hal/emulated/rig/convert_pose2sim.h"
#include "hal/emulated/rig/fault_port.h"
#include "hal/emulated/rig/recording_scene.h"
#include "hal/emulated/rig/rig.h"
#include "hal/emulated/rig/rig_file.h"
#include "hal/emulated/rig/run_record.h"
#include "hal/emulated/rig/socket.h"
#include "hal/emulated/rig/stamp_scene.h"
#include "hal/emulated/studio/depth_feed.h"
#include "hal/emulated/studio/progress_bar.h"
#include "hal/emulated/studio/scene_cache.h"
#include "hal/emulated/studio/studio_scene.h"
#include "hal/emulated/studio/truth.h"
#include "rt/stop_signals.h"

namespace {

struct Arguments {
  std::uint32_t cameras = 20;
  std::string size = "1280x1024";
  std::string scene = "stamp";
  std::string first_address = "127.0.0.1";
  double link_gbps = 1;
  double seconds = 0;
  double warm_up_s = 0;
  std::string stats;
  std::string rig_out;
  emulator::RigOptions rig;
  emulator::studio::StudioOptions studio;
  std::string truth;
  std::string convert_kind;
  std::string convert_from;
  std::string convert_to;
  std::string fault;
};

int fail(const std::string& message) {
  std::fprintf(stderr, "kagami-emulator: %s\n", message.c_str());
  return 1;
}

std::expected<emulator::SizePx, std::string> parseSize(const std::string& text) {
  unsigned width = 0;
  unsigned height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) != 2 || width % 4 != 0 ||
      height % 2 != 0 || width > 16384 || height > 16384) {
    return std::unexpected("--size " + text +
                           ": say WIDTHxHEIGHT with a width that 4 divides, an even height and "
                           "no side over 16384");
  }
  return emulator::SizePx{width, height};
}

void declare(CLI::App& app, Arguments& a) {
  app.add_option("--cameras", a.cameras,
                 "cameras in the stamp scene or the studio; a recording has its own")
      ->check(CLI::Range(1, 250))
      ->capture_default_str();
  app.add_option("--size", a.size, "their size in pixels")->capture_default_str();
  app.add_option("--scene", a.scene,
                 "what they see: stamp, studio, or a folder with rig.toml and recordings")
      ->capture_default_str();
  app.add_option("--first-address", a.first_address, "camera i answers on this address + i")
      ->capture_default_str();
  app.add_option("--wire-port", a.rig.wire_port, "UDP port of the trigger wire on 127.0.0.1")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  app.add_option("--link-gbps", a.link_gbps, "speed of each camera's link")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  app.add_option("--mtu", a.rig.max_packet_bytes, "largest packet size a client may set")
      ->check(CLI::Range(576, 16000))
      ->capture_default_str();
  app.add_option("--wire-log", a.rig.wire_log, "CSV file: the instants of every frame sent");
  app.add_option("--fault-port", a.rig.fault_port,
                 "UDP port on the first address for faults on command; 0: none")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--fault-log", a.rig.fault_log, "CSV file: every fault and what came of it");
  app.add_option("--stats", a.stats, "JSON file at exit: counts, lateness, validity");
  app.add_option("--rig-out", a.rig_out, "write rig.toml of the stamp scene or the studio there");
  app.add_option("--studio-seed", a.studio.seed, "another hall, other people, other throws")
      ->capture_default_str();
  app.add_option("--studio-seconds", a.studio.play_s, "length of the studio's play")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
  app.add_option("--studio-cache", a.studio.cache,
                 "folder that keeps what was drawn; default: kagami/studio in the user's cache");
  app.add_option("--studio-cache-gib", a.studio.cache_gib, "limit of that folder; 0: keeps nothing")
      ->check(CLI::Range(0.0, 10'000.0))
      ->capture_default_str();
  app.add_option("--studio-grow", a.studio.grow, "go on drawing the play while no camera sends")
      ->capture_default_str();
  app.add_flag("--depth-sensor", a.studio.depth_sensor,
               "feed the emulated depth sensor with the studio, too");
  app.add_option("--studio-truth", a.truth, "folder for the studio's ground truth");
  app.add_option("--realtime-priority", a.rig.realtime_priority, "SCHED_FIFO priority; 0: none")
      ->check(CLI::Range(0, 99))
      ->capture_default_str();
  app.add_option("--internal-trigger-hz", a.rig.internal_trigger_hz,
                 "fire Line1 from inside at this rate; 0: from the wire only")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  app.add_option("--seconds", a.seconds, "stop after this time; 0: run until stopped")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_option("--warm-up-s", a.warm_up_s,
                 "time after the first edge in which lateness does not make the run invalid")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--opto-delays-us", a.rig.opto_delays_us,
                 "what each camera's Line1 takes to see an edge; one value per camera")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--loss", a.rig.loss, "probability that a stream packet is lost")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--seed", a.rig.seed, "of the losses")->capture_default_str();
}

using ScenePointer = std::unique_ptr<emulator::Scene>;

std::expected<ScenePointer, std::string> openStudio(const Arguments& a) {
  const auto size = parseSize(a.size);
  if (!size) return std::unexpected(size.error());
  emulator::studio::StudioOptions options = a.studio;
  options.cameras = a.cameras;
  options.size = *size;
  if (options.cache.empty()) options.cache = emulator::studio::usualCache();
  emulator::studio::ProgressBar bar;
  auto scene = emulator::studio::StudioScene::make(
      options, [&bar](double share, const char* what) { bar.show(share, what); });
  if (!scene) return std::unexpected(scene.error());
  if (!a.rig_out.empty()) {
    if (auto written = emulator::writeRigFile(a.rig_out, (*scene)->rig()); !written) {
      return std::unexpected(written.error());
    }
  }
  if (!a.truth.empty()) {
    if (auto written = emulator::studio::writeTruth(a.truth, options); !written) {
      return std::unexpected(written.error());
    }
  }
  return std::move(*scene);
}

/// The emulated depth sensor is plugged in while this lives; none is asked for: nullptr.
std::expected<std::unique_ptr<emulator::studio::DepthFeed>, std::string> feedDepth(
    const Arguments& a, const emulator::Scene& scene) {
  const auto* studio = dynamic_cast<const emulator::studio::StudioScene*>(&scene);
  if (studio == nullptr || !a.studio.depth_sensor) return nullptr;
  return emulator::studio::DepthFeed::begin(*studio, a.truth);
}

/// Which trigger showed which moment is known only at the end: while the play grows, it begins
/// again earlier.
std::expected<void, std::string> closeStudio(const Arguments& a, const emulator::Scene& scene) {
  const auto* studio = dynamic_cast<const emulator::studio::StudioScene*>(&scene);
  if (studio == nullptr || a.truth.empty()) return {};
  return emulator::studio::writeRounds(a.truth, studio->rounds());
}

std::expected<ScenePointer, std::string> openScene(const Arguments& a) {
  if (a.scene == "studio") return openStudio(a);
  if (!a.truth.empty()) return std::unexpected("--studio-truth is for --scene studio");
  if (a.studio.depth_sensor) return std::unexpected("--depth-sensor is for --scene studio");
  if (a.scene != "stamp") {
    if (!a.rig_out.empty()) {
      return std::unexpected("--rig-out is for stamp and studio; this scene has its own rig.toml");
    }
    auto recording = emulator::RecordingScene::open(a.scene);
    if (!recording) return std::unexpected(recording.error());
    return std::make_unique<emulator::RecordingScene>(std::move(*recording));
  }
  const auto size = parseSize(a.size);
  if (!size) return std::unexpected(size.error());
  auto stamp = emulator::StampScene::make(a.cameras, *size);
  if (!stamp) return std::unexpected("--size " + a.size + ": " + stamp.error());
  if (!a.rig_out.empty()) {
    if (auto written = emulator::writeRigFile(a.rig_out, stamp->rig()); !written) {
      return std::unexpected(written.error());
    }
  }
  return std::make_unique<emulator::StampScene>(std::move(*stamp));
}

int serve(Arguments& a, const rt::StopSignals& stop) {
  const auto address = emulator::parseAddress(a.first_address);
  if (!address) return fail("--first-address " + address.error());
  a.rig.first_address = *address;
  a.rig.link_bits_per_second = a.link_gbps * 1e9;
  a.rig.warm_up = rt::Nanoseconds{static_cast<std::int64_t>(a.warm_up_s * 1e9)};
  if (a.seconds > 0) {
    a.rig.run_for = rt::Nanoseconds{static_cast<std::int64_t>(a.seconds * 1e9)};
  }
  const auto scene = openScene(a);
  if (!scene) return fail(scene.error());
  auto rig = emulator::Rig::open(**scene, a.rig);
  if (!rig) return fail(rig.error());
  auto depth = feedDepth(a, **scene);
  if (!depth) return fail(depth.error());
  const double cpu_at_ready = emulator::processCpuSeconds();
  std::puts("ready");
  std::fflush(stdout);
  if (auto served = rig->run(stop); !served) return fail(served.error());
  if (auto closed = closeStudio(a, **scene); !closed) return fail(closed.error());

  const auto reason = emulator::invalidReason(rig->record(), rig->triggerPeriod());
  if (!reason.empty()) std::fprintf(stderr, "kagami-emulator: run INVALID: %s\n", reason.c_str());
  if (!a.stats.empty()) {
    if (auto written = emulator::writeStatistics(a.stats, (*scene)->cameraCount(), rig->record(),
                                                 rig->triggerPeriod(),
                                                 emulator::processCpuSeconds() - cpu_at_ready);
        !written) {
      return fail(written.error());
    }
  }
  return 0;
}

int commandFault(const Arguments& a) {
  const auto address = emulator::parseAddress(a.first_address);
  if (!address) return fail("--first-address " + address.error());
  const auto answer = emulator::commandFault(*address, a.rig.fault_port, a.fault);
  if (!answer) return fail(answer.error());
  std::puts(answer->c_str());
  return *answer == "ok" ? 0 : 1;
}

int convert(const Arguments& a) {
  const auto rig = emulator::convertPose2sim(a.convert_from, a.convert_to);
  if (!rig) return fail(rig.error());
  std::printf("%s: %zu cameras, target_m [%.3f, %.3f, %.3f]\n", a.convert_to.c_str(),
              rig->cameras.size(), rig->target_m[0], rig->target_m[1], rig->target_m[2]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const rt::StopSignals stop;  // before any thread
  CLI::App app("Emulates GigE Vision cameras and the wire that triggers them.");
  Arguments arguments;
  declare(app, arguments);
  CLI::App* converter = app.add_subcommand("convert", "make a scene folder of other people's data");
  converter->add_option("kind", arguments.convert_kind, "pose2sim")
      ->required()
      ->check(CLI::IsMember({"pose2sim"}));
  converter->add_option("source", arguments.convert_from, "the data")->required();
  converter->add_option("destination", arguments.convert_to, "the folder to make")->required();
  CLI::App* fault = app.add_subcommand("fault", "make a camera of a running emulator do wrong");
  fault->add_option("command", arguments.fault, "as in docs/emulator.md, for example: \"7 kill\"")
      ->required();
  fault->fallthrough();  // --first-address and --fault-port choose the emulator
  CLI11_PARSE(app, argc, argv);
  if (*fault) return commandFault(arguments);
  return *converter ? convert(arguments) : serve(arguments, stop);
}

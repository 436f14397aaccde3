// Kills one camera after the other under a running daemon and revives it; prints how long each took
// to show frames again and what the others lost meanwhile. No test: its figures are the machine's.
//   camera_revival [--cameras 20] [--times 50] [--size 1280x1024] [--rate 40] [--packet-size 9000]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "rt/clock.h"
#include "tests/support/child_process.h"
#include "tests/support/fault_port.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr const char* kFirstAddress = "127.0.8.1";
constexpr std::uint16_t kFaultPort = 3984;
constexpr double kBar_s = 2;

struct Options {
  int cameras = 20;
  int times = 50;
  std::string size = "1280x1024";
  std::string rate = "40";
  std::string packet_size = "9000";
};

struct Outage {
  int camera = 0;  // from 0
  rt::Timestamp killed;
  rt::Timestamp revived;
};

struct Stored {
  std::uint64_t trigger = 0;
  rt::Timestamp ready;
};

struct Run {
  std::map<int, std::vector<Stored>> frames;  // by camera, from 0
  std::map<std::uint64_t, rt::Timestamp> edges;
};

Run readTrace(const std::filesystem::path& path) {
  Run run;
  std::ifstream trace(path);
  for (std::string line; std::getline(trace, line);) {
    const json record = json::parse(line, nullptr, false);
    if (record.is_discarded()) continue;
    if (record["record"] == "frame" && record["trigger"] != 0) {
      run.frames[record["camera"]].push_back(
          {record["trigger"], rt::fromNs(record["frame_ready_ns"].get<std::int64_t>())});
    } else if (record["record"] == "trigger") {
      run.edges[record["trigger"]] =
          rt::fromNs(record["trigger_edge_before_ns"].get<std::int64_t>());
    }
  }
  return run;
}

/// Seconds from the revival to the first frame after it; negative: none came.
double secondsToFrames(const Run& run, const Outage& outage) {
  const auto found = run.frames.find(outage.camera);
  if (found == run.frames.end()) return -1;
  for (const Stored& frame : found->second) {
    if (frame.ready > outage.revived) {
      return std::chrono::duration<double>(frame.ready - outage.revived).count();
    }
  }
  return -1;
}

/// Triggers without a frame of a camera that nothing had happened to, between the first and the
/// last outage.
std::size_t lostByOthers(const Run& run, const std::vector<Outage>& outages, int cameras) {
  std::size_t lost = 0;
  const rt::Timestamp begin = outages.front().killed;
  const rt::Timestamp end = outages.back().revived;
  for (int camera = 0; camera < cameras; ++camera) {
    std::set<std::uint64_t> stored;
    const auto found = run.frames.find(camera);
    if (found != run.frames.end()) {
      for (const Stored& frame : found->second) stored.insert(frame.trigger);
    }
    for (const auto& [trigger, edge] : run.edges) {
      if (edge < begin || edge > end || stored.contains(trigger)) continue;
      // Its own outages: the frame on the wire at the kill, and the way back.
      const bool own = std::ranges::any_of(outages, [&](const Outage& outage) {
        return outage.camera == camera && edge > outage.killed - 100ms &&
               edge < outage.revived + 5s;
      });
      lost += own ? 0 : 1;
    }
  }
  return lost;
}

std::string addresses(int cameras) {
  std::string list = "[";
  for (int i = 1; i <= cameras; ++i) {
    list += (i > 1 ? ",\"127.0.8." : "\"127.0.8.") + std::to_string(i) + "\"";
  }
  return list + "]";
}

int fail(const std::string& what) {
  std::fprintf(stderr, "camera_revival: %s\n", what.c_str());
  return EXIT_FAILURE;
}

int measure(const Options& options) {
  const test::TemporaryFolder folder;
  test::ChildProcess rig({KAGAMI_EMULATOR, "--cameras", std::to_string(options.cameras), "--size",
                          options.size, "--first-address", kFirstAddress, "--wire-port", "3985",
                          "--fault-port", std::to_string(kFaultPort), "--rig-out",
                          folder / "rig.toml", "--stats", folder / "stats.json",
                          // Hardware is never late for want of a processor.
                          "--realtime-priority", "85"},
                         folder / "emulator.log");
  if (!rig.waitForOutput("ready", 60s)) return fail(rig.output());
  test::ChildProcess daemon({KAGAMID,        "--config",
                             KAGAMID_CONFIG,                                                      //
                             "--set",        "rig.file=" + (folder / "rig.toml").string(),        //
                             "--set",        "cameras.addresses=" + addresses(options.cameras),   //
                             "--set",        "cameras.packet_size_bytes=" + options.packet_size,  //
                             "--set",        "trigger.wire_port=3985",
                             "--set",        "trigger.rate_hz=" + options.rate,  //
                             "--set",        "trigger.genlock=false",
                             "--set",        "history.sets=40",
                             "--set",        "display.refresh_hz=10",  //
                             "--set",        "control.bus=none",
                             "--set",        "state.trace=" + (folder / "trace.jsonl").string()},
                            folder / "kagamid.log");
  if (!daemon.waitForOutput("running:", 120s)) return fail(daemon.output());
  std::this_thread::sleep_for(3s);

  std::mt19937 random(1);                                 // the same times in every run
  std::uniform_int_distribution<int> dead_ms(500, 6000);  // around the camera's heartbeat of 3 s
  std::vector<Outage> outages;
  for (int i = 0; i < options.times; ++i) {
    Outage outage{.camera = i * 7 % options.cameras, .killed = rt::now(), .revived = {}};
    const std::string camera = std::to_string(outage.camera + 1);
    if (test::sendFault(kFirstAddress, kFaultPort, camera + " kill") != "ok") {
      return fail("the emulator takes no faults");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(dead_ms(random)));
    outage.revived = rt::now();
    if (test::sendFault(kFirstAddress, kFaultPort, camera + " revive") != "ok") {
      return fail("the emulator takes no faults");
    }
    outages.push_back(outage);
    std::this_thread::sleep_for(2500ms);
  }
  std::this_thread::sleep_for(3s);
  daemon.terminate();
  if (daemon.wait(60s) != 0) return fail(daemon.output());
  rig.terminate();
  (void)rig.wait(20s);

  const Run run = readTrace(folder / "trace.jsonl");
  std::printf("%7s %12s %22s\n", "camera", "dead for (s)", "frames again after (s)");
  std::vector<double> taken;
  std::size_t in_time = 0;
  for (const Outage& outage : outages) {
    const double seconds = secondsToFrames(run, outage);
    taken.push_back(seconds);
    in_time += seconds >= 0 && seconds <= kBar_s ? 1 : 0;
    std::printf("%7d %12.2f %22.3f\n", outage.camera + 1,
                std::chrono::duration<double>(outage.revived - outage.killed).count(), seconds);
  }
  std::ranges::sort(taken);
  std::printf(
      "a revived camera shows frames within %.0f s: %zu of %zu (median %.3f s, longest %.3f s)\n",
      kBar_s, in_time, outages.size(), taken[taken.size() / 2], taken.back());
  std::printf("the other %d cameras lost %zu frames of %zu triggers\n", options.cameras - 1,
              lostByOthers(run, outages, options.cameras), run.edges.size());
  // An emulator that was late itself must not blame the receiver.
  const json stats = json::parse(std::ifstream(folder / "stats.json"), nullptr, false);
  if (!stats.is_discarded() && !stats["valid"].get<bool>()) {
    std::printf("not a valid run for losses: %s\n",
                stats["invalid_reason"].get<std::string>().c_str());
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    const std::string value = argv[i + 1];
    if (name == "--cameras") options.cameras = std::max(std::atoi(value.c_str()), 1);
    if (name == "--times") options.times = std::max(std::atoi(value.c_str()), 1);
    if (name == "--size") options.size = value;
    if (name == "--rate") options.rate = value;
    if (name == "--packet-size") options.packet_size = value;
  }
  return measure(options);
}

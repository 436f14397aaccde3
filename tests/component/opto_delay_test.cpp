// Cameras whose opto-isolated inputs differ, and what they expose: read from the emulator's log of
// what it really did.

#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/child_process.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::Each;
using testing::ElementsAre;

constexpr std::int64_t kExposure_ns = 1'000'000;

/// A short run of three cameras whose inputs take 5, 62.5 and 80 us.
class OptoRun {
 public:
  explicit OptoRun(const std::string& configured_us) {
    test::ChildProcess emulator(
        {KAGAMI_EMULATOR, "--cameras", "3", "--size", "320x256", "--first-address", "127.0.6.1",
         "--wire-port", "3986", "--rig-out", folder_ / "rig.toml", "--wire-log",
         folder_ / "wire.csv", "--opto-delays-us", "5,62.5,80"},
        folder_ / "emulator.log");
    if (!emulator.waitForOutput("ready", 30s)) {
      ADD_FAILURE() << emulator.output();
      return;
    }
    test::ChildProcess daemon({KAGAMID,
                               "--config",
                               KAGAMID_CONFIG,
                               "--set",
                               "rig.file=" + path("rig.toml"),
                               "--set",
                               R"(cameras.addresses=["127.0.6.1","127.0.6.2","127.0.6.3"])",
                               "--set",
                               "cameras.opto_delay_us=" + configured_us,
                               "--set",
                               "trigger.wire_port=3986",
                               "--set",
                               "trigger.rate_hz=10",
                               "--set",
                               "history.sets=20",
                               "--set",
                               "display.width_px=320",
                               "--set",
                               "display.height_px=180",
                               "--set",
                               "state.trace=" + path("trace.jsonl"),
                               "--set",
                               "control.bus=none"},
                              folder_ / "kagamid.log");
    if (!daemon.waitForOutput("running:", 60s)) {
      ADD_FAILURE() << daemon.output();
      return;
    }
    std::this_thread::sleep_for(2s);
    daemon.terminate();
    EXPECT_EQ(daemon.wait(60s), 0) << daemon.output();
    emulator.terminate();
    EXPECT_EQ(emulator.wait(20s), 0) << emulator.output();
    readWireLog();
    readTrace();
  }

  /// Per trigger: when each camera's exposure ended, after the edge and its exposure time.
  std::map<long, std::vector<std::int64_t>> delays_ns;
  std::size_t frames = 0;
  std::size_t unattributed = 0;

 private:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  void readWireLog() {
    std::ifstream log(folder_ / "wire.csv");
    std::string line;
    std::getline(log, line);
    while (std::getline(log, line)) {
      int camera = 0;
      long frame_id = 0;
      long trigger = 0;
      long edge_ns = 0;
      long exposure_end_ns = 0;
      ASSERT_EQ(std::sscanf(line.c_str(), "%d,%ld,%ld,%ld,%ld", &camera, &frame_id, &trigger,
                            &edge_ns, &exposure_end_ns),
                5)
          << line;
      auto& delays = delays_ns[trigger];
      delays.resize(3);
      delays.at(static_cast<std::size_t>(camera)) = exposure_end_ns - edge_ns - kExposure_ns;
    }
  }
  void readTrace() {
    std::ifstream trace(folder_ / "trace.jsonl");
    for (std::string line; std::getline(trace, line);) {
      const json record = json::parse(line);
      if (record["record"] != "frame") continue;
      ++frames;
      unattributed += record["trigger"] == 0 ? 1 : 0;
    }
  }

  test::TemporaryFolder folder_;
};

TEST(OptoDelay, ExposesAllCamerasAtTheSameInstantWhenTheDelaysAreKnown) {
  const OptoRun run("[5,62.5,80]");
  ASSERT_GT(run.delays_ns.size(), 10U);
  for (const auto& [trigger, delays] : run.delays_ns)
    EXPECT_THAT(delays, Each(80'000)) << "trigger " << trigger;
  EXPECT_GT(run.frames, 30U);
  EXPECT_EQ(run.unattributed, 0U);
}

TEST(OptoDelay, IsSeenInEveryFrameWhenNobodyTellsTheDaemon) {
  const OptoRun run("[]");
  ASSERT_GT(run.delays_ns.size(), 10U);
  for (const auto& [trigger, delays] : run.delays_ns)
    EXPECT_THAT(delays, ElementsAre(5'000, 62'500, 80'000)) << "trigger " << trigger;
}

}  // namespace

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

#include "appliance/tools/emulator_files.h"
#include "tests/support/box_commands.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trace_records.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::Each;
using testing::ElementsAre;

constexpr std::int64_t kExposure_ns = 1'000'000;
const test::CameraNetwork kNetwork{.first_address = "127.0.6.1", .cameras = 3, .wire_port = 3986};

/// A short run of three cameras whose inputs take 5, 62.5 and 80 us.
class OptoRun {
 public:
  explicit OptoRun(const std::string& configured_us) {
    test::ChildProcess emulator(
        emulatorCommand(kNetwork, "320x256", folder_.path(),
                        {"--wire-log", folder_ / "wire.csv", "--opto-delays-us", "5,62.5,80"}),
        folder_ / "emulator.log");
    if (!emulator.waitForOutput("ready", 30s)) {
      ADD_FAILURE() << emulator.output();
      return;
    }
    test::ChildProcess daemon(kagamidCommand(kNetwork, folder_.path(),
                                             {"cameras.opto_delay_us=" + configured_us,
                                              "display.width_px=320", "display.height_px=180",
                                              "state.trace=" + (folder_ / "trace.jsonl").string()}),
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
  std::map<std::uint64_t, std::vector<std::int64_t>> delays_ns;
  std::size_t frames = 0;
  std::size_t unattributed = 0;

 private:
  void readWireLog() {
    std::ifstream log(folder_ / "wire.csv");
    const auto frames_sent = appliance::readWireLog(log, "wire.csv");
    ASSERT_TRUE(frames_sent) << frames_sent.error();
    for (const appliance::SentFrame& frame : *frames_sent) {
      auto& delays = delays_ns[frame.trigger];
      delays.resize(3);
      delays.at(frame.camera) = (frame.exposure_end - frame.trigger_edge).count() - kExposure_ns;
    }
  }
  void readTrace() {
    auto records = test::readTrace(folder_ / "trace.jsonl");
    for (const json& frame : records["frame"]) {
      ++frames;
      unattributed += frame["trigger"] == 0 ? 1 : 0;
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

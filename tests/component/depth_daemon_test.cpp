// The daemon with a depth sensor: it runs beside cameras and screen, and never in their way.

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/component/private_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/depth_feed.h"

namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class DepthDaemon : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_.address().empty()) GTEST_SKIP() << "dbus-daemon is not installed";
    ASSERT_TRUE(emulator_.waitForOutput("ready", 30s)) << emulator_.output();
  }

  void TearDown() override {
    if (!daemon_) return;
    daemon_->terminate();
    EXPECT_EQ(daemon_->wait(60s), 0) << daemon_->output();
  }

  void run(std::vector<std::string> settings) {
    settings.insert(
        settings.end(),
        {"rig.file=" + (folder_ / "rig.toml").string(), R"(cameras.addresses=["127.0.9.1"])",
         "cameras.packet_size_bytes=1500", "trigger.wire_port=3989", "trigger.rate_hz=10",
         "history.sets=40", "display.refresh_hz=20", "control.bus=" + bus_.address()});
    std::vector<std::string> command{KAGAMID, "--config", KAGAMID_CONFIG};
    for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
    daemon_ = std::make_unique<test::ChildProcess>(command, folder_ / "kagamid.log");
    ASSERT_TRUE(daemon_->waitForOutput("running:", 60s)) << daemon_->output();
  }

  std::string kagami(std::vector<std::string> words) {
    words.insert(words.begin(), {KAGAMI, "--bus", bus_.address()});
    test::ChildProcess program(words, folder_ / "kagami.log");
    return program.wait(20s) == 0 ? program.output() : "";
  }

  /// Whether `kagami status` comes to say @p text, within a generous time.
  testing::AssertionResult says(const std::string& text) {
    std::string last;
    for (int i = 0; i < 100; ++i) {
      last = kagami({"status"});
      if (last.find(text) != std::string::npos) return testing::AssertionSuccess();
      std::this_thread::sleep_for(100ms);
    }
    return testing::AssertionFailure() << last;
  }

  test::TemporaryFolder folder_;
  PrivateBus bus_;
  test::ChildProcess emulator_{
      {KAGAMI_EMULATOR, "--cameras", "1", "--size", "448x320", "--first-address", "127.0.9.1",
       "--wire-port", "3989", "--rig-out", (folder_ / "rig.toml").string()},
      folder_ / "emulator.log"};
  std::unique_ptr<test::ChildProcess> daemon_;
};

TEST_F(DepthDaemon, TellsHowItsSensorFares) {
  auto feed = std::make_unique<test::DepthFeed>();
  run({"depth_sensor.backend=openni", std::string("depth_sensor.drivers=") + KAGAMI_DEPTH_DRIVERS,
       "depth_sensor.width_px=320", "depth_sensor.height_px=240"});
  EXPECT_TRUE(says("depth    streaming: Kagami Emulated RGB-D, 320x240 with colour, "));
  feed.reset();
  EXPECT_TRUE(says("depth    lost: Kagami Emulated RGB-D"));
  EXPECT_TRUE(says("degraded: no depth sensor found: plug it in"));
  feed = std::make_unique<test::DepthFeed>();
  EXPECT_TRUE(says("came back 1 times"));
  const auto look = [this] { return json::parse(kagami({"status", "--json"})); };
  json status = look();
  // Pictures a second are told after the first second of pictures.
  for (int i = 0; i < 100 && status.at("shown_hz") == 0; ++i) {
    std::this_thread::sleep_for(100ms);
    status = look();
  }
  EXPECT_EQ(status.at("frames_lost"), 0) << "the cameras never noticed";
  EXPECT_GT(status.at("shown_hz"), 0);
}

TEST_F(DepthDaemon, RunsWithoutASensorThatCannotBeOpened) {
  run({"depth_sensor.backend=folder", "depth_sensor.source=/nowhere"});
  EXPECT_TRUE(
      says("degraded: /nowhere: there is no such folder: correct depth_sensor.source; the "
           "box runs without its depth sensor"));
}

TEST_F(DepthDaemon, NamesTheBackendsThereAre) {
  run({"depth_sensor.backend=lidar"});
  EXPECT_TRUE(says(R"(is not one of "none", "openni", "folder")"));
}

TEST(DepthTools, MeasureALatencyByALampInThePicture) {
  const test::TemporaryFolder folder;
  const std::string ring = "/dev/shm/kagami-depth-lamp-test-" + std::to_string(::getpid());
  ::setenv("KAGAMI_DEPTH_RING", ring.c_str(), 1);
  const std::string lamp = folder / "lamp.txt";
  test::ChildProcess feeder({KAGAMI_DEPTH_FEEDER, "--lamp-log", lamp}, folder / "feeder.log");
  test::ChildProcess latency({KAGAMI, "depth", "latency", "--config", KAGAMID_CONFIG, "--seconds",
                              "12", "--lamp-log", lamp, "--set", "depth_sensor.backend=openni",
                              "--set", std::string("depth_sensor.drivers=") + KAGAMI_DEPTH_DRIVERS},
                             folder / "latency.log");
  ASSERT_EQ(latency.wait(60s), 0) << latency.output() << feeder.output();
  double latency_ms = 0;
  const std::string said = latency.output();
  ASSERT_EQ(std::sscanf(said.c_str(), "latency_ms = %lf", &latency_ms), 1) << said;
  // 40 ms, and what a busy machine adds to even its most punctual arrival.
  EXPECT_GE(latency_ms, 38);
  EXPECT_LE(latency_ms, 60);
}

TEST(DepthTools, TheEmulatorRefusesADepthSensorWhereItsSceneHasNone) {
  const test::TemporaryFolder folder;
  test::ChildProcess emulator({KAGAMI_EMULATOR, "--scene", "stamp", "--depth-sensor"},
                              folder / "emulator.log");
  EXPECT_EQ(emulator.wait(30s), 1);
  EXPECT_EQ(emulator.output(), "kagami-emulator: --depth-sensor is for --scene studio\n");
}

}  // namespace

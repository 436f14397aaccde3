// The daemon with a depth sensor: it runs beside cameras and screen, and never in their way.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/commanded_box.h"
#include "tests/support/depth_feed.h"
#include "tests/support/temporary_folder.h"

namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class DepthDaemon : public test::CommandedBox {
 protected:
  DepthDaemon() : CommandedBox({.first_address = "127.0.9.1", .cameras = 1, .wire_port = 3989}) {}
};

TEST_F(DepthDaemon, TellsHowItsSensorFares) {
  auto feed = std::make_unique<test::DepthFeed>();
  startDaemon({"depth_sensor.backend=openni",
               std::string("depth_sensor.drivers=") + KAGAMI_DEPTH_DRIVERS,
               "depth_sensor.width_px=320", "depth_sensor.height_px=240"});
  EXPECT_TRUE(says("depth    streaming: Kagami Emulated RGB-D, 320x240 with colour, "));
  feed.reset();
  EXPECT_TRUE(says("depth    lost: Kagami Emulated RGB-D"));
  EXPECT_TRUE(says("degraded: no depth sensor found: plug it in"));
  feed = std::make_unique<test::DepthFeed>();
  EXPECT_TRUE(says("came back 1 times"));
  // Pictures a second are known after the first second of pictures.
  EXPECT_TRUE(becomes([](const json& status) { return status.at("shown_hz") > 0; }));
  EXPECT_EQ(status().at("frames_lost"), 0) << "the cameras never noticed";
}

TEST_F(DepthDaemon, WritesASnapshotWhileItRuns) {
  const test::DepthFeed feed;
  startDaemon({"depth_sensor.backend=openni",
               std::string("depth_sensor.drivers=") + KAGAMI_DEPTH_DRIVERS,
               "depth_sensor.width_px=320", "depth_sensor.height_px=240",
               "state.directory=" + (folder() / "state").string()});
  ASSERT_TRUE(says("depth    streaming: "));
  const auto taken =
      kagami({"depth", "snapshot", "--frames", "10", "--out", folder() / "snapshot"});
  EXPECT_EQ(taken.exit_status, 0) << taken.text;
  for (const char* pictures : {"depth", "colour"}) {
    std::error_code none;
    const std::filesystem::directory_iterator files(folder() / "snapshot" / pictures, none);
    EXPECT_EQ(std::distance(begin(files), end(files)), 10) << pictures;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder() / "state" / "depth"));
}

TEST_F(DepthDaemon, RunsWithoutASensorThatCannotBeOpened) {
  startDaemon({"depth_sensor.backend=folder", "depth_sensor.source=/nowhere"});
  EXPECT_TRUE(
      says("degraded: /nowhere: there is no such folder: correct depth_sensor.source; the "
           "box runs without its depth sensor"));
}

TEST_F(DepthDaemon, NamesTheBackendsThereAre) {
  startDaemon({"depth_sensor.backend=lidar"});
  EXPECT_TRUE(says(R"(is not one of "none", "openni", "folder")"));
}

TEST(DepthTools, MeasureALatencyByALampInThePicture) {
  const test::TemporaryFolder folder;
  const test::TemporaryFolder shared_memory("/dev/shm");  // a killed feeder leaves its ring
  ::setenv("KAGAMI_DEPTH_RING", (shared_memory / "ring").c_str(), 1);
  const std::string lamp = folder / "lamp.txt";
  // Small pictures: under a sanitizer too they are drawn in time.
  test::ChildProcess feeder(
      {KAGAMI_DEPTH_FEEDER, "--width", "320", "--height", "240", "--lamp-log", lamp},
      folder / "feeder.log");
  test::ChildProcess latency(
      {KAGAMI, "depth", "latency", "--config", KAGAMID_CONFIG, "--seconds", "12", "--lamp-log",
       lamp, "--set", "depth_sensor.backend=openni", "--set",
       std::string("depth_sensor.drivers=") + KAGAMI_DEPTH_DRIVERS, "--set",
       "depth_sensor.width_px=320", "--set", "depth_sensor.height_px=240"},
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

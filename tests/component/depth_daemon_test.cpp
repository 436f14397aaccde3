// The daemon with a depth sensor: it runs beside cameras and screen, and never in their way.

#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/commanded_box.h"
#include "tests/support/depth_feed.h"

namespace {

using nlohmann::json;

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
  // Pictures a second are told after the first second of pictures.
  EXPECT_TRUE(becomes([](const json& status) { return status.at("shown_hz") > 0; }));
  EXPECT_EQ(status().at("frames_lost"), 0) << "the cameras never noticed";
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

}  // namespace

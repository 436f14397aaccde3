#include <memory>
#include <string>
#include <utility>

#include "hal/openni/folder_sensor.h"
#include "hal/openni/openni_sensor.h"
#include "tests/conformance/depth_sensor_suite.h"
#include "tests/support/depth_feed.h"
#include "tests/support/depth_recordings.h"

namespace test {
namespace {

using hal::openni::FolderSensor;
using hal::openni::OpenniSensor;

OpenDepthSensor live() {
  auto feed = std::make_shared<DepthFeed>();
  auto sensor = OpenniSensor::open(
      {.drivers = KAGAMI_DEPTH_DRIVERS, .width_px = 320, .height_px = 240, .latency = 40ms});
  if (!sensor) {
    ADD_FAILURE() << sensor.error();
    return {};
  }
  return {std::move(feed), std::move(*sensor)};
}

OpenDepthSensor oniFile() {
  auto scratch = std::make_shared<ScratchFolder>();
  EXPECT_TRUE(recordOni(*scratch, scratch->file("a.oni")));
  auto sensor = OpenniSensor::open({.source = scratch->file("a.oni")});
  if (!sensor) {
    ADD_FAILURE() << sensor.error();
    return {};
  }
  return {std::move(scratch), std::move(*sensor)};
}

OpenDepthSensor folder() {
  auto scratch = std::make_shared<ScratchFolder>();
  EXPECT_TRUE(recordOni(*scratch, scratch->file("a.oni")));
  EXPECT_TRUE(runDepth(
      *scratch, {"export", "--source", scratch->file("a.oni"), "--jpeg", scratch->file("folder")}));
  auto sensor = FolderSensor::open({.folder = scratch->file("folder")});
  if (!sensor) {
    ADD_FAILURE() << sensor.error();
    return {};
  }
  return {std::move(scratch), std::move(*sensor)};
}

INSTANTIATE_TEST_SUITE_P(Backends, DepthSensorConformance,
                         testing::Values(DepthBackend{"Live", live},
                                         DepthBackend{"OniFile", oniFile},
                                         DepthBackend{"Folder", folder}),
                         [](const auto& backend) { return backend.param.name; });

}  // namespace
}  // namespace test

#include <memory>
#include <string>
#include <utility>

#include "hal/openni/folder_sensor.h"
#include "hal/openni/openni_sensor.h"
#include "tests/conformance/depth_sensor_suite.h"
#include "tests/support/depth_feed.h"
#include "tests/support/depth_recordings.h"
#include "tests/support/temporary_folder.h"

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
  auto scratch = std::make_shared<TemporaryFolder>();
  EXPECT_TRUE(recordOni(*scratch, *scratch / "a.oni"));
  auto sensor = OpenniSensor::open({.source = *scratch / "a.oni"});
  if (!sensor) {
    ADD_FAILURE() << sensor.error();
    return {};
  }
  return {std::move(scratch), std::move(*sensor)};
}

OpenDepthSensor folder() {
  auto scratch = std::make_shared<TemporaryFolder>();
  EXPECT_TRUE(recordOni(*scratch, *scratch / "a.oni"));
  EXPECT_TRUE(runDepth(*scratch,
                       {"export", "--source", *scratch / "a.oni", "--jpeg", *scratch / "folder"}));
  auto sensor = FolderSensor::open({.folder = *scratch / "folder"});
  if (!sensor) {
    ADD_FAILURE() << sensor.error();
    return {};
  }
  return {std::move(scratch), std::move(*sensor)};
}

INSTANTIATE_TEST_SUITE_P(Backends, DepthSensorConformance,
                         testing::Values(DepthBackend{"Live", false, live},
                                         DepthBackend{"OniFile", true, oniFile},
                                         DepthBackend{"Folder", true, folder}),
                         [](const auto& backend) { return backend.param.name; });

}  // namespace
}  // namespace test

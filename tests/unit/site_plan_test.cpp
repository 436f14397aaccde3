#include "appliance/site/site_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::Config;
using appliance::fitToNetwork;
using appliance::Rig;
using testing::HasSubstr;
using testing::StartsWith;

Rig twentyCameras() {
  Rig rig;
  rig.cameras.resize(20);
  for (auto& camera : rig.cameras) camera.width_px = 1280, camera.height_px = 1024;
  return rig;
}

TEST(SitePlan, FillsInThePacketDelay) {
  Config config;
  config.network.uplinks = 1;
  const auto fitted = fitToNetwork(config, twentyCameras());
  ASSERT_TRUE(fitted) << fitted.error();
  EXPECT_NEAR(fitted->config.cameras.packet_delay_ns, 80'000, 500);
  EXPECT_TRUE(fitted->lowered.empty());
}

TEST(SitePlan, LeavesADelayThatIsConfigured) {
  Config config;
  config.cameras.packet_delay_ns = 0;
  const auto fitted = fitToNetwork(config, twentyCameras());
  ASSERT_TRUE(fitted) << fitted.error();
  EXPECT_EQ(fitted->config.cameras.packet_delay_ns, 0);
}

TEST(SitePlan, LowersARateThatNoLinkCarriesAndSaysSo) {
  Config config;
  config.network.uplinks = 1;
  config.trigger.rate_hz = 60;
  const auto fitted = fitToNetwork(config, twentyCameras());
  ASSERT_TRUE(fitted) << fitted.error();
  EXPECT_NEAR(fitted->config.trigger.rate_hz, 44.9, 1e-9);
  EXPECT_THAT(textOf(fitted->lowered),
              StartsWith("triggers run at 44.9 Hz instead of 60: 20 cameras of "));
  EXPECT_THAT(textOf(fitted->lowered), HasSubstr("use 2 x 10 Gb/s uplinks"));
  EXPECT_GT(fitted->config.cameras.packet_delay_ns, 0);
}

TEST(SitePlan, RefusesANetworkThatCarriesNextToNothing) {
  Config config;
  config.network = {.uplinks = 1, .uplink_gbps = 0.1, .camera_link_gbps = 1};
  const auto fitted = fitToNetwork(config, twentyCameras());
  ASSERT_FALSE(fitted);
  EXPECT_THAT(fitted.error(), StartsWith("[network-refused] network: 20 cameras of "));
  EXPECT_EQ(fitted.error().find('\n'), std::string::npos);
}

TEST(SitePlan, PlansForTheLargestCameraOfAMixedRig) {
  Rig rig = twentyCameras();
  rig.cameras[7].height_px = 2048;
  const auto parameters = networkParameters(Config{}, rig);
  EXPECT_EQ(parameters.cameras, 20U);
  EXPECT_EQ(parameters.height_px, 2048U);
}

}  // namespace

// The arithmetic of the uplinks, held against figures that were worked out by hand.

#include "appliance/network/network_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::frameOnWire;
using appliance::highestRate_hz;
using appliance::NetworkParameters;
using appliance::planNetwork;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint64_t kFrameBytes = 1280 * 1024;

double need_gbps(double rate_hz, std::uint32_t packet_size_bytes) {
  return 20 * rate_hz * frameOnWire(kFrameBytes, packet_size_bytes).bits() * 1e-9;
}

double us(rt::Nanoseconds t) {
  return static_cast<double>(t.count()) * 1e-3;
}

TEST(NetworkPlan, CountsEveryBitOfAFrameOnTheWire) {
  EXPECT_NEAR(frameOnWire(kFrameBytes, 1500).bits(), 11.02e6, 0.005e6);
  EXPECT_NEAR(frameOnWire(kFrameBytes, 9000).bits(), 10.57e6, 0.005e6);
  EXPECT_EQ(frameOnWire(kFrameBytes, 9000).packets, 149U);
  // A leader of 72 bytes, a trailer that is padded to 46, 38 bytes of Ethernet around each.
  EXPECT_EQ(frameOnWire(0, 1500).bytes, 110U + 84U);
  EXPECT_EQ(frameOnWire(1464, 1500).bytes, 1538U + 110U + 84U);
  EXPECT_EQ(frameOnWire(1465, 1500).bytes, 1538U + 84U + 110U + 84U);
}

TEST(NetworkPlan, GivesTheRatesOfTwentyCameras) {
  EXPECT_NEAR(need_gbps(40, 1500), 8.81, 0.01);
  EXPECT_NEAR(need_gbps(40, 9000), 8.46, 0.01);
  EXPECT_NEAR(need_gbps(50, 1500), 11.0, 0.05);
  EXPECT_NEAR(need_gbps(50, 9000), 10.6, 0.05);
  EXPECT_NEAR(need_gbps(60, 1500), 13.2, 0.05);
  EXPECT_NEAR(need_gbps(60, 9000), 12.7, 0.05);
  EXPECT_NEAR(highestRate_hz({.uplinks = 1}), 44.9, 0.05);
}

TEST(NetworkPlan, SpreadsThePacketsOfTwentyCamerasOverOneUplink) {
  const auto plan = planNetwork({.uplinks = 1});
  ASSERT_TRUE(plan) << plan.error().line();
  EXPECT_NEAR(us(plan->packet_delay), 80, 0.5);
  EXPECT_NEAR(plan->uplink_gbps, 8.46, 0.01);
  EXPECT_NEAR(static_cast<double>(plan->undelayed_bytes), 13.4e6, 0.1e6);
  EXPECT_LT(plan->buffer_bytes, 200'000U) << "one packet of each camera";
}

TEST(NetworkPlan, HalvesTheTransferWithTwoUplinks) {
  const auto one = planNetwork({.uplinks = 1});
  const auto two = planNetwork({.uplinks = 2});
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(us(two->packet_delay), 3.8, 0.05);
  // 21 and 10.5 ms at full speed; links are filled to 95 %.
  EXPECT_NEAR(us(one->transfer), 21e3 / 0.95, 500);
  EXPECT_NEAR(us(two->transfer), 10.5e3 / 0.95, 200);
}

TEST(NetworkPlan, NeedsNoDelayWhereEveryCameraCanSendAtFullSpeed) {
  const auto plan = planNetwork({.uplinks = 1, .uplink_gbps = 25});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->packet_delay.count(), 0);
  EXPECT_EQ(plan->buffer_bytes, plan->undelayed_bytes);
}

TEST(NetworkPlan, LetsAFrameLeaveBeforeTheNextOneIsDue) {
  const NetworkParameters parameters{.rate_hz = 44.9, .uplinks = 1};
  const auto plan = planNetwork(parameters);
  ASSERT_TRUE(plan) << plan.error().line();
  EXPECT_LE(us(plan->transfer), 1e6 / parameters.rate_hz);
}

TEST(NetworkPlan, RefusesInPlainWordsAndNamesWhatIsPossible) {
  const auto plan = planNetwork({.rate_hz = 60, .uplinks = 1});
  ASSERT_FALSE(plan);
  EXPECT_EQ(textOf(plan.error().reason),
            "20 cameras of 1280x1024 at 60 Hz need 12.7 Gb/s of the uplink, "
            "1 x 10 Gb/s carries 9.5");
  EXPECT_THAT(plan.error().line(),
              AllOf(HasSubstr(": lower the rate to 44.9 Hz, or lower the pictures' height to "),
                    HasSubstr(" px, or use 2 x 10 Gb/s uplinks, or use 1 x 25 Gb/s uplink")));
}

TEST(NetworkPlan, OffersLargerPacketsWhereTheyAreEnough) {
  const auto plan = planNetwork({.rate_hz = 44, .packet_size_bytes = 1500, .uplinks = 1});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().line(), HasSubstr("use packets of 9000 bytes"));
}

TEST(NetworkPlan, NamesACameraThatItsOwnLinkCannotCarry) {
  const auto plan = planNetwork({.rate_hz = 40, .uplink_gbps = 100, .camera_link_gbps = 0.1});
  ASSERT_FALSE(plan);
  EXPECT_EQ(textOf(plan.error().reason),
            "a camera of 1280x1024 at 40 Hz needs 0.423 Gb/s, its link carries 0.095");
  EXPECT_EQ(plan.error().line().find("uplink"), std::string::npos) << plan.error().line();
}

}  // namespace

// What is decided about a camera's network without a camera.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/aravis/link_speed.h"
#include "hal/aravis/packet_size.h"
#include "hal/aravis/resend.h"

namespace {

using hal::CameraProfile;
using testing::ElementsAre;

TEST(PacketSizes, GoDownFromTheAskedOneByTheUsualOnes) {
  EXPECT_THAT(hal::aravis::packetSizesBelow(9000), ElementsAre(9000, 8192, 4000, 1500, 1400, 576));
  EXPECT_THAT(hal::aravis::packetSizesBelow(1500), ElementsAre(1500, 1400, 576));
  EXPECT_THAT(hal::aravis::packetSizesBelow(576), ElementsAre(576));
}

TEST(PacketSizes, KeepTheCamerasShareOfTheUplink) {
  const CameraProfile profile{.packet_size_bytes = 9000, .packet_delay_ns = 79'903};
  EXPECT_EQ(hal::aravis::delayForSize(profile, 9000), 79'903U);
  EXPECT_NEAR(hal::aravis::delayForSize(profile, 1500), 79'903 * 1538.0 / 9038, 1);
}

TEST(LinkSpeed, OfAHundredMegabitsIsToldWithItsPrice) {
  const CameraProfile profile{.width_px = 1280, .height_px = 1024, .link_mbps = 1000};
  EXPECT_EQ(hal::aravis::slowLink(profile, 100),
            "its link runs at 100 Mb/s instead of 1000: a frame takes 105 ms instead of 10: check "
            "its cable and the switch's port");
  EXPECT_EQ(hal::aravis::slowLink(profile, 1000), "");
  EXPECT_EQ(hal::aravis::slowLink(profile, 2500), "");
  EXPECT_EQ(hal::aravis::slowLink(CameraProfile{}, 10), "") << "without a plan any link is right";
}

TEST(ResendPolicy, IsTheModelsOwnWhereItHasOne) {
  CameraProfile profile;
  profile.resend_by_model = {{.model = "slow", .policy = {.packet_timeout_us = 8000}}};
  EXPECT_EQ(hal::aravis::resendPolicyFor(profile, "slow").packet_timeout_us, 8000U);
  EXPECT_EQ(hal::aravis::resendPolicyFor(profile, "slow ").packet_timeout_us, 3000U);
  EXPECT_EQ(hal::aravis::resendPolicyFor(profile, "").packet_timeout_us, 3000U);
}

}  // namespace

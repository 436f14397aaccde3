#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/aravis/arrival_stamps.h"
#include "hal/aravis/feature_profile.h"
#include "hal/aravis/frame_id.h"

namespace {

using namespace hal::aravis;

TEST(FrameIdUnwrapper, CountsOnAcrossTheWrapFrom65535To1) {
  FrameIdUnwrapper ids;
  EXPECT_EQ(ids.unwrap(65534), 65534U);
  EXPECT_EQ(ids.unwrap(65535), 65535U);
  EXPECT_EQ(ids.unwrap(1), 65536U);
  EXPECT_EQ(ids.unwrap(2), 65537U);
}

TEST(FrameIdUnwrapper, KeepsAGapVisibleAcrossTheWrap) {
  FrameIdUnwrapper ids;
  EXPECT_EQ(ids.unwrap(65533), 65533U);
  EXPECT_EQ(ids.unwrap(3), 65538U) << "four frames were lost";
}

TEST(FrameIdUnwrapper, PassesExtendedIdsAsTheyAre) {
  FrameIdUnwrapper ids;
  EXPECT_EQ(ids.unwrap(1'000'000), 1'000'000U);
}

TEST(ArrivalStamps, GiveTheOldestStampToTheFrameDeliveredNext) {
  ArrivalStamps stamps;
  stamps.begin(rt::fromNs(10));
  stamps.begin(rt::fromNs(20));  // the next frame begins before the first one is whole
  EXPECT_EQ(stamps.deliver(rt::fromNs(99)), rt::fromNs(10));
  EXPECT_EQ(stamps.deliver(rt::fromNs(99)), rt::fromNs(20));
  EXPECT_EQ(stamps.deliver(rt::fromNs(99)), rt::fromNs(99)) << "its begin was not seen";
}

TEST(FeatureProfile, SwitchesEveryAutomaticFunctionOffBeforeItsManualValue) {
  const auto settings = featureSettings({});
  const auto at = [&](const char* name) {
    return std::ranges::find(settings, std::string(name), &FeatureSetting::name);
  };
  EXPECT_LT(at("ExposureAuto"), at("ExposureTime"));
  EXPECT_LT(at("GainAuto"), at("Gain"));
  EXPECT_LT(at("BalanceWhiteAuto"), at("BalanceRatio"));
  EXPECT_LT(at("PixelFormat"), at("Width")) << "a format may change the size's increments";
  ASSERT_NE(at("TriggerMode"), settings.end());
  EXPECT_GT(at("TriggerMode"), at("TriggerSource"));
}

TEST(FeatureProfile, DelaysTheTriggerAndForgivesOnlyAMissingZero) {
  const auto delayOf = [](double delay_us) {
    const auto settings = featureSettings({.trigger_delay_us = delay_us});
    return *std::ranges::find(settings, std::string("TriggerDelay"), &FeatureSetting::name);
  };
  EXPECT_EQ(std::get<double>(delayOf(12.5).value), 12.5);
  EXPECT_EQ(delayOf(12.5).older_name, "TriggerDelayAbs");
  EXPECT_FALSE(delayOf(12.5).optional);
  EXPECT_TRUE(delayOf(0).optional) << "a camera without the feature does not delay";
}

TEST(FeatureProfile, LeavesTheTriggerOffForACameraThatRunsFree) {
  const auto settings = featureSettings({.trigger_source = std::string(hal::kFreeRunning)});
  const auto mode = std::ranges::find(settings, std::string("TriggerMode"), &FeatureSetting::name);
  ASSERT_NE(mode, settings.end());
  EXPECT_EQ(std::get<std::string>(mode->value), "Off");
}

TEST(FeatureProfile, AcceptsACamerasRoundingButNotAnotherValue) {
  EXPECT_TRUE(inForce(1000, 1008));
  EXPECT_TRUE(inForce(0, 0.004));
  EXPECT_FALSE(inForce(1000, 5000));
  EXPECT_FALSE(inForce(0, 1));
}

}  // namespace

#include <algorithm>
#include <set>

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

TEST(FrameIdUnwrapper, CountsOnForACameraThatDoesNotSkipZero) {
  FrameIdUnwrapper ids;
  EXPECT_EQ(ids.unwrap(65535), 65535U);
  EXPECT_EQ(ids.unwrap(0), 65536U);
  EXPECT_EQ(ids.unwrap(1), 65537U);
  EXPECT_EQ(ids.unwrap(65535), 65536U + 65535U);
  EXPECT_EQ(ids.unwrap(1), 65536U + 65537U) << "the frame with the id 0 was lost";
}

TEST(FrameIdUnwrapper, IsNotMisledByAFrameWithoutLeader) {
  FrameIdUnwrapper ids;
  EXPECT_EQ(ids.unwrap(300), 300U);
  EXPECT_EQ(ids.ofDamaged(301), 301U) << "its leader came";
  EXPECT_EQ(ids.ofDamaged(12), 0U) << "the id of the buffer's frame before";
  EXPECT_EQ(ids.ofDamaged(0), 0U) << "of a buffer that never had one";
  EXPECT_EQ(ids.unwrap(303), 303U);
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
  EXPECT_THAT(delayOf(12.5).other_names, testing::ElementsAre("TriggerDelayAbs"));
  EXPECT_FALSE(delayOf(12.5).optional);
  EXPECT_TRUE(delayOf(0).optional) << "a camera without the feature does not delay";
}

TEST(FeatureProfile, LeavesTheTriggerOffForACameraThatRunsFree) {
  const auto settings = featureSettings({.trigger_source = std::string(hal::kFreeRunning)});
  const auto mode = std::ranges::find(settings, std::string("TriggerMode"), &FeatureSetting::name);
  ASSERT_NE(mode, settings.end());
  EXPECT_EQ(std::get<std::string>(mode->value), "Off");
}

/// What namedFor() makes of the profile in front of a camera with exactly these features.
std::expected<std::vector<FeatureSetting>, std::string> named(std::set<std::string> features,
                                                              hal::CameraProfile profile = {}) {
  return namedFor(featureSettings(profile),
                  [&](const std::string& name) { return features.contains(name); });
}

std::set<std::string> standardFeatures() {
  std::set<std::string> features;
  for (const FeatureSetting& setting : featureSettings({})) features.insert(setting.name);
  return features;
}

std::set<std::string> without(std::set<std::string> features, const std::string& name) {
  features.erase(name);
  return features;
}

TEST(FeatureNames, AreTheStandardsWhereTheCameraHasThem) {
  const auto settings = named(standardFeatures());
  ASSERT_TRUE(settings) << settings.error();
  EXPECT_EQ(settings->size(), featureSettings({}).size());
}

TEST(FeatureNames, AreAnotherFirmwaresWhereTheUnitIsTheSame) {
  std::set<std::string> features = standardFeatures();
  for (const auto& [standard, other] :
       {std::pair{"ExposureTime", "ExposureTimeAbs"}, std::pair{"TriggerDelay", "TriggerDelayAbs"},
        std::pair{"AcquisitionFrameRateEnable", "AcquisitionFrameRateEnabled"},
        std::pair{"Gain", "GainAbs"}}) {
    features.erase(standard);
    features.insert(other);
  }
  const auto settings = named(features, {.gain_db = 6});
  ASSERT_TRUE(settings) << settings.error();
  std::set<std::string> names;
  for (const FeatureSetting& setting : *settings) names.insert(setting.name);
  EXPECT_EQ(names, features);
}

TEST(FeatureNames, LeaveOutWhatACameraNeedNotHave) {
  const auto settings = named(without(standardFeatures(), "BalanceWhiteAuto"));
  ASSERT_TRUE(settings) << settings.error();
  EXPECT_EQ(settings->size(), featureSettings({}).size() - 1);
}

TEST(FeatureNames, TellEverythingThatIsMissingAndWhatTheCameraHasInstead) {
  auto features = without(without(standardFeatures(), "ExposureTime"), "TriggerSource");
  features.insert("ExposureTimeRaw");
  const auto settings = named(features);
  ASSERT_FALSE(settings);
  EXPECT_EQ(settings.error(),
            "its firmware has no ExposureTime or ExposureTimeAbs (it has ExposureTimeRaw, in units "
            "that only its maker knows), no TriggerSource");
}

TEST(FeatureNames, NeverSetAGainInUnknownUnits) {
  auto features = without(standardFeatures(), "Gain");
  features.insert("GainRaw");
  EXPECT_TRUE(named(features, {.gain_db = 0})) << "as switched on";
  EXPECT_FALSE(named(features, {.gain_db = 6}));
}

TEST(FeatureProfile, AcceptsACamerasRoundingButNotAnotherValue) {
  EXPECT_TRUE(inForce(1000, 1008));
  EXPECT_TRUE(inForce(0, 0.004));
  EXPECT_FALSE(inForce(1000, 5000));
  EXPECT_FALSE(inForce(0, 1));
}

}  // namespace

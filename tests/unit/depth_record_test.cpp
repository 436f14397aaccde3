#include "appliance/depth/depth_record.h"

#include <array>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/depth/lamp_finder.h"

namespace {

using appliance::DepthRecord;
using namespace std::chrono_literals;

constexpr rt::Timestamp kStart = rt::fromNs(1'000'000'000'000);
constexpr std::array<std::uint8_t, 3> kPixel{};

void add(DepthRecord& record, std::uint64_t number, rt::Nanoseconds at, bool colour = true) {
  record.onFrame({.colour_rgb = colour ? std::span<const std::uint8_t>(kPixel)
                                       : std::span<const std::uint8_t>(),
                  .number = number,
                  .exposure = kStart + at - 40ms,
                  .frame_ready = kStart + at});
}

TEST(DepthRecord, TellsLostPicturesFromOutages) {
  DepthRecord record;
  add(record, 5, 0ms);
  add(record, 6, 33ms);
  add(record, 8, 100ms);  // 7 is lost
  add(record, 9, 133ms, false);
  add(record, 60, 1833ms);  // it was unplugged
  add(record, 61, 1866ms);
  EXPECT_EQ(record.frames(), 6u);
  EXPECT_EQ(record.lost(), 1u);
  EXPECT_EQ(record.withoutColour(), 1u);
  EXPECT_THAT(record.outages(), testing::ElementsAre(1700ms));
  EXPECT_EQ(record.longestInterval(), 67ms);
  EXPECT_EQ(record.length(), 1866ms);
  EXPECT_NEAR(record.rate_hz(), 5 / 0.166, 0.01);
}

TEST(DepthRecord, TakesNumbersThatBeginAnewForNoLoss) {
  DepthRecord record;
  add(record, 900, 0ms);
  add(record, 1, 33ms);
  add(record, 2, 66ms);
  EXPECT_EQ(record.lost(), 0u);
  EXPECT_NEAR(record.rate_hz(), 30.3, 0.1);
}

TEST(DepthRecord, HasNoRateOfOnePicture) {
  DepthRecord record;
  EXPECT_EQ(record.rate_hz(), 0);
  add(record, 1, 0ms);
  EXPECT_EQ(record.rate_hz(), 0);
}

TEST(LampFinder, FindsTheSpotThatChangesMost) {
  appliance::LampFinder finder;
  constexpr std::uint32_t kWidth = 80;
  constexpr std::uint32_t kHeight = 60;
  for (int i = 0; i < 10; ++i) {
    std::vector<std::uint8_t> rgb(std::size_t{3} * kWidth * kHeight, 100);
    for (std::size_t x = 0; x < 30; ++x) rgb[x] = static_cast<std::uint8_t>(100 + i);  // a little
    const bool on = i % 3 == 0;
    for (std::uint32_t y = 40; y < 44; ++y)
      for (std::uint32_t x = 60; x < 64; ++x)
        for (std::uint32_t k = 0; k < 3; ++k)
          rgb[3 * (std::size_t{y} * kWidth + x) + k] = on ? 250 : 50;
    finder.add({.colour_rgb = rgb,
                .width_px = kWidth,
                .height_px = kHeight,
                .colour_exposure = kStart + i * 33ms});
  }
  const auto samples = finder.samples();
  ASSERT_EQ(samples.size(), 10u);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(samples[static_cast<std::size_t>(i)].at, kStart + i * 33ms);
    EXPECT_NEAR(samples[static_cast<std::size_t>(i)].brightness, i % 3 == 0 ? 250 : 50, 1e-3);
  }
}

}  // namespace

#include "appliance/light/flicker.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace {

using appliance::backgroundLuminance;
using appliance::FlickerCompensation;

constexpr std::uint32_t kWidth = 128;
constexpr std::uint32_t kHeight = 96;

std::vector<std::byte> plain(int value) {
  return std::vector<std::byte>(std::size_t{kWidth} * kHeight, static_cast<std::byte>(value));
}

TEST(BackgroundLuminance, IsTheMeanOfAPlainFrame) {
  EXPECT_DOUBLE_EQ(backgroundLuminance(plain(90), kWidth, kHeight), 90);
}

TEST(BackgroundLuminance, CountsTheFourColoursOfABayerCellAlike) {
  auto frame = plain(0);
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      frame[y * kWidth + x] = static_cast<std::byte>(40 * (y % 2) + 20 * (x % 2));
    }
  }
  EXPECT_DOUBLE_EQ(backgroundLuminance(frame, kWidth, kHeight), 30);
}

TEST(BackgroundLuminance, DoesNotSeeWhoMovesInTheMiddle) {
  auto frame = plain(90);
  for (std::uint32_t y = kHeight / 4 + 2; y < kHeight * 3 / 4; ++y) {
    for (std::uint32_t x = kWidth / 4 + 2; x < kWidth * 3 / 4; ++x) {
      frame[y * kWidth + x] = std::byte{255};
    }
  }
  EXPECT_DOUBLE_EQ(backgroundLuminance(frame, kWidth, kHeight), 90);
}

TEST(BackgroundLuminance, StaysInsideFramesOfAnySize) {
  for (std::uint32_t width = 1; width < 70; width += 3) {
    for (std::uint32_t height = 1; height < 70; height += 7) {
      const std::vector<std::byte> frame(std::size_t{width} * height, std::byte{7});
      const double seen = backgroundLuminance(frame, width, height);
      EXPECT_EQ(seen, width < 2 || height < 2 ? 0 : 7) << width << "x" << height;
    }
  }
  EXPECT_EQ(backgroundLuminance(plain(9), kWidth + 1, kHeight), 0) << "the frame is too short";
}

TEST(FlickerCompensation, EvensOutABeat) {
  FlickerCompensation compensation;
  double least = 1e9;
  double most = 0;
  for (int n = 0; n < 400; ++n) {
    const double luminance = 100 * (1 + 0.3 * std::cos(std::numbers::pi * n + 0.4));
    const double shown = compensation.gain(0, luminance) * luminance;
    if (n < 200) continue;
    least = std::min(least, shown);
    most = std::max(most, shown);
  }
  EXPECT_LT(most / least, 1.02) << "of " << 1.28 / 0.72;
  const auto report = compensation.report();
  EXPECT_NEAR(report.before, 0.3 * std::cos(0.4), 0.01);
  EXPECT_LT(report.after, 1e-6);
}

TEST(FlickerCompensation, FollowsASlowChange) {
  FlickerCompensation compensation;
  double gain = 0;
  for (int n = 0; n < 2000; ++n) gain = compensation.gain(3, n < 1000 ? 100 : 50);
  EXPECT_NEAR(gain, 1, 1e-3);
}

TEST(FlickerCompensation, LeavesTheFirstPictureAndTheDarkAlone) {
  FlickerCompensation compensation;
  EXPECT_FLOAT_EQ(compensation.gain(0, 80), 1);
  EXPECT_FLOAT_EQ(compensation.gain(1, 20), 1) << "every camera has a mean of its own";
  EXPECT_FLOAT_EQ(compensation.gain(0, 0), 1);
  EXPECT_FLOAT_EQ(compensation.gain(FlickerCompensation::kCameras, 80), 1);
}

TEST(FlickerCompensation, NeverGoesBeyondItsLimitsAndTellsWhatRemains) {
  FlickerCompensation compensation;
  for (int n = 0; n < 300; ++n) {
    const float gain = compensation.gain(0, n % 2 == 0 ? 200 : 10);
    EXPECT_GE(gain, 1 / FlickerCompensation::kMostGain);
    EXPECT_LE(gain, FlickerCompensation::kMostGain);
  }
  EXPECT_GT(compensation.report().after, 0.1);
}

}  // namespace

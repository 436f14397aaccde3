#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hal/depth_sensor.h"

/// What every backend of hal::DepthSensor must do. A test program includes this once and
/// instantiates DepthSensorConformance with its backends.
namespace test {

using namespace std::chrono_literals;

/// A sensor and what it needs to live.
struct OpenDepthSensor {
  std::shared_ptr<void> hardware;  ///< may be none
  std::unique_ptr<hal::DepthSensor> sensor;
};

/// A sensor, or a recording of a second or more that repeats, that sees a person between 1 and
/// 6 m away in the middle of a room, with colour.
struct DepthBackend {
  const char* name;
  bool repeats;  ///< a recording begins again at its end
  std::function<OpenDepthSensor()> open;
};

class DepthSensorConformance : public testing::TestWithParam<DepthBackend> {
 protected:
  void SetUp() override { ASSERT_TRUE(open_.sensor) << "the backend did not open"; }
  OpenDepthSensor open_ = GetParam().open();
  hal::DepthSensor* sensor_ = open_.sensor.get();
};

TEST_P(DepthSensorConformance, DeliversRegisteredPairsOfOneSize) {
  for (int i = 0; i < 5; ++i) {
    const auto frame = sensor_->waitFrame(20s);
    ASSERT_TRUE(frame) << sensor_->status().message;
    const std::size_t pixels = std::size_t{frame->width_px} * frame->height_px;
    ASSERT_GT(pixels, 0u);
    EXPECT_EQ(frame->depth_mm.size(), pixels);
    EXPECT_EQ(frame->colour_rgb.size(), 3 * pixels);
  }
}

TEST_P(DepthSensorConformance, MeasuresMillimetresThroughItsLens) {
  const auto frame = sensor_->waitFrame(20s);
  ASSERT_TRUE(frame) << sensor_->status().message;
  std::size_t measured = 0;
  for (const std::uint16_t mm : frame->depth_mm) {
    if (mm == 0) continue;
    ++measured;
    ASSERT_GT(mm, 300);
    ASSERT_LT(mm, 10000);
  }
  EXPECT_GT(measured, frame->depth_mm.size() / 2);
  // The field of view of this family of sensors is 50 to 80 degrees.
  EXPECT_GT(frame->lens.focal_x_px, 0.5 * frame->width_px);
  EXPECT_LT(frame->lens.focal_x_px, 1.2 * frame->width_px);
  EXPECT_GT(frame->colour_lens.focal_x_px, 0.5 * frame->width_px);
  EXPECT_NEAR(frame->lens.centre_x_px, 0.5 * frame->width_px, 0.1 * frame->width_px);
  EXPECT_NEAR(frame->lens.centre_y_px, 0.5 * frame->height_px, 0.1 * frame->height_px);
}

TEST_P(DepthSensorConformance, NumbersAndExposuresRise) {
  auto before = sensor_->waitFrame(20s);
  ASSERT_TRUE(before) << sensor_->status().message;
  const rt::Timestamp first = before->exposure;
  int restarts = 0;
  for (int i = 0; i < 15; ++i) {
    const std::uint64_t number = before->number;
    const rt::Timestamp exposure = before->exposure;
    before = sensor_->waitFrame(20s);
    ASSERT_TRUE(before);
    // Where pictures come slowly, a recording comes to its end: once a second at most.
    if (GetParam().repeats && before->number <= number) {
      EXPECT_LE(++restarts, (before->exposure - first) / 1s);
    } else {
      EXPECT_GT(before->number, number);
    }
    EXPECT_GT(before->exposure, exposure);
    EXPECT_LE(before->exposure, before->frame_ready);
    EXPECT_LE(before->colour_exposure, before->frame_ready);
    EXPECT_LT(std::chrono::abs(before->colour_exposure - before->exposure), 17ms)
        << "half a period";
    EXPECT_LE(before->frame_ready, rt::now());  // nothing from the future
  }
}

TEST_P(DepthSensorConformance, TellsItsStateFromAnyThread) {
  ASSERT_TRUE(sensor_->waitFrame(20s)) << sensor_->status().message;
  const hal::DepthStatus status = sensor_->status();
  EXPECT_EQ(status.state, hal::DepthState::kStreaming);
  EXPECT_GE(status.frames, 1u);
  EXPECT_FALSE(status.name.empty());
  EXPECT_TRUE(status.colour);
  EXPECT_EQ(status.message, "");
}

TEST_P(DepthSensorConformance, WaitsNoLongerThanAsked) {
  ASSERT_TRUE(sensor_->waitFrame(20s));
  // A picture may be there immediately; after a few there is none.
  for (int i = 0; i < 100 && sensor_->waitFrame(0ns); ++i) {
  }
  const rt::Timestamp before = rt::now();
  (void)sensor_->waitFrame(0ns);
  EXPECT_LT(rt::now() - before, 5s);
}

TEST_P(DepthSensorConformance, KeepsThePictureUntilTheNextCall) {
  const auto frame = sensor_->waitFrame(20s);
  ASSERT_TRUE(frame);
  const std::vector<std::uint16_t> copy(frame->depth_mm.begin(), frame->depth_mm.end());
  std::this_thread::sleep_for(200ms);  // time to be overwritten
  EXPECT_TRUE(std::ranges::equal(copy, frame->depth_mm));
}

}  // namespace test

// The emulated depth sensor without OpenNI2: the ring that feeds it and what it does to a picture.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/emulated/openni/practice_room.h"
#include "hal/emulated/openni/ring.h"
#include "hal/emulated/openni/sensor_clock.h"
#include "hal/emulated/openni/sensor_model.h"

namespace {

using emulator::DepthRingReader;
using emulator::DepthRingWriter;
using emulator::RgbdFormat;
using emulator::SensorModel;
using emulator::SensorTraits;
using testing::HasSubstr;
using namespace std::chrono_literals;

std::string ringPath(const char* name) {
  return std::string("/dev/shm/kagami-ring-test-") + name + "-" + std::to_string(::getpid());
}

RgbdFormat tiny() {
  return {
      .width_px = 64, .height_px = 48, .focal_px = 57, .centre_x_px = 31.5, .centre_y_px = 23.5};
}

void publish(DepthRingWriter& writer, float value, rt::Timestamp exposure) {
  const auto canvas = writer.begin();
  std::ranges::fill(canvas.depth_m, value);
  std::ranges::fill(canvas.colour_rgb, static_cast<std::uint8_t>(value));
  (void)writer.publish(exposure);
}

TEST(DepthRing, HandsPicturesOverByTheirNumbers) {
  const std::string path = ringPath("numbers");
  auto writer = DepthRingWriter::create(path, tiny());
  ASSERT_TRUE(writer) << writer.error();
  const auto reader = DepthRingReader::open(path);
  ASSERT_TRUE(reader) << reader.error();
  EXPECT_EQ(reader->format().width_px, 64u);
  EXPECT_EQ(reader->newest(), 0u);
  for (int i = 1; i <= 20; ++i) publish(*writer, static_cast<float>(i), rt::fromNs(i * 1000));
  EXPECT_EQ(reader->newest(), 20u);
  std::vector<float> depth_m(tiny().pixels());
  std::vector<std::uint8_t> rgb(3 * tiny().pixels());
  for (std::uint64_t number = 20 - DepthRingWriter::kSlots + 1; number <= 20; ++number) {
    ASSERT_TRUE(reader->read(number, depth_m, rgb));
    EXPECT_EQ(depth_m.front(), static_cast<float>(number));
    EXPECT_EQ(rgb.back(), number);
    EXPECT_EQ(reader->stamp(number)->exposure,
              rt::fromNs(static_cast<std::int64_t>(number) * 1000));
  }
}

TEST(DepthRing, RefusesPicturesThatAreOverwrittenOrNotThere) {
  const std::string path = ringPath("gone");
  auto writer = DepthRingWriter::create(path, tiny());
  ASSERT_TRUE(writer) << writer.error();
  const auto reader = DepthRingReader::open(path);
  ASSERT_TRUE(reader) << reader.error();
  for (int i = 1; i <= 12; ++i) publish(*writer, 1, rt::fromNs(i));
  EXPECT_FALSE(reader->stamp(0));
  EXPECT_FALSE(reader->stamp(12 - DepthRingWriter::kSlots));
  EXPECT_FALSE(reader->stamp(13));
  (void)writer->begin();  // drawing 13 where 5 was
  EXPECT_FALSE(reader->stamp(5));
}

TEST(DepthRing, IsPluggedWhileItsWriterLivesAndSaysSo) {
  const std::string path = ringPath("plug");
  auto writer = DepthRingWriter::create(path, tiny());
  ASSERT_TRUE(writer) << writer.error();
  const auto reader = DepthRingReader::open(path);
  ASSERT_TRUE(reader) << reader.error();
  EXPECT_TRUE(reader->plugged());
  writer->setPlugged(false);
  EXPECT_FALSE(reader->plugged());
  writer->setPlugged(true);
  EXPECT_TRUE(reader->plugged());
  writer = std::unexpected("gone");
  EXPECT_FALSE(reader->plugged());
  EXPECT_FALSE(DepthRingReader::open(path));
}

TEST(DepthRing, WakesAReaderThatWaits) {
  const std::string path = ringPath("wake");
  auto writer = DepthRingWriter::create(path, tiny());
  ASSERT_TRUE(writer) << writer.error();
  const auto reader = DepthRingReader::open(path);
  ASSERT_TRUE(reader) << reader.error();
  std::jthread feeder([&] {
    std::this_thread::sleep_for(20ms);
    publish(*writer, 1, rt::now());
  });
  const rt::Timestamp before = rt::now();
  while (reader->newest() == 0 && rt::now() < before + 50s) reader->waitAfter(0, 60s);
  EXPECT_EQ(reader->newest(), 1u);
}

TEST(DepthRing, HasOneWriter) {
  const std::string path = ringPath("one");
  const auto writer = DepthRingWriter::create(path, tiny());
  ASSERT_TRUE(writer) << writer.error();
  const auto second = DepthRingWriter::create(path, tiny());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error(), HasSubstr("another emulator writes to it"));
}

TEST(DepthRing, RefusesWhatIsNoRing) {
  const std::string path = ringPath("bad");
  EXPECT_FALSE(DepthRingReader::open(path));
  std::ofstream(path) << std::string(10'000, 'x');
  const auto reader = DepthRingReader::open(path);
  ASSERT_FALSE(reader);
  EXPECT_THAT(reader.error(), HasSubstr("not one of this version"));
  std::ofstream(path) << "short";
  EXPECT_FALSE(DepthRingReader::open(path));
  EXPECT_EQ(::unlink(path.c_str()), 0);
  EXPECT_FALSE(DepthRingWriter::create("/nowhere/ring", tiny()));
  EXPECT_FALSE(DepthRingWriter::create(path, {.width_px = 0}));
}

TEST(SensorClock, RunsFastAndDeliversLate) {
  const emulator::SensorClock clock{.power_on = rt::fromNs(1'000'000'000), .drift_ppm = 50};
  EXPECT_EQ(clock.stamp_us(rt::fromNs(1'000'000'000)), 0u);
  EXPECT_EQ(clock.stamp_us(rt::fromNs(101'000'000'000)), 100'005'000u);
  for (std::uint64_t i = 1; i < 100; ++i) {
    const auto late = clock.arrival(rt::fromNs(0), i) - rt::fromNs(0);
    EXPECT_GE(late, clock.latency);
    EXPECT_LE(late, clock.latency + clock.jitter);
  }
}

/// What the model makes of a flat wall.
struct Wall {
  double share = 0;  // of pixels that are measured
  double mean_mm = 0;
  double rms_mm = 0;
};
Wall wallAt(double distance_m, const SensorTraits& traits = {}) {
  const RgbdFormat format = {.width_px = 640, .height_px = 100};
  SensorModel model(traits, format);
  const std::vector<float> depth_m(format.pixels(), static_cast<float>(distance_m));
  std::vector<std::uint16_t> mm(format.pixels());
  double n = 0;
  double sum = 0;
  double squares = 0;
  for (std::uint64_t number = 1; number <= 20; ++number) {
    model.senseDepth(depth_m, {}, number, mm);
    for (const std::uint16_t value : mm) {
      if (value == 0) continue;
      n += 1;
      sum += value;
      squares += 1.0 * value * value;
    }
  }
  const double mean = sum / n;
  return {n / (20.0 * static_cast<double>(mm.size())), mean, std::sqrt(squares / n - mean * mean)};
}

TEST(SensorModel, MeasuresTheTruthOnTheWhole) {
  for (const double distance_m : {1.0, 2.0, 3.0, 5.0}) {
    const Wall wall = wallAt(distance_m);
    EXPECT_NEAR(wall.mean_mm, 1000 * distance_m, 4 * distance_m * distance_m) << distance_m;
    EXPECT_GT(wall.share, 0.97);
  }
}

TEST(SensorModel, ErrorsGrowWithTheSquareOfTheDistance) {
  const double near_mm = wallAt(1.5).rms_mm;
  const double far_mm = wallAt(6.0).rms_mm;
  EXPECT_GT(near_mm, 2);
  EXPECT_GT(far_mm / near_mm, 10);
  EXPECT_LT(far_mm / near_mm, 24);
}

TEST(SensorModel, SeesNothingTooNearAndTooFar) {
  EXPECT_LT(wallAt(0.3).share, 1e-9);
  EXPECT_LT(wallAt(9.5).share, 1e-9);
}

TEST(SensorModel, QuantisesInStepsOfDisparity) {
  const RgbdFormat format = {.width_px = 640, .height_px = 16};
  SensorModel model({.disparity_noise_px = 0}, format);
  std::vector<float> depth_m(format.pixels());
  for (std::size_t i = 0; i < depth_m.size(); ++i)
    depth_m[i] = 3 + 0.5F * static_cast<float>(i % 640) / 640;
  std::vector<std::uint16_t> mm(format.pixels());
  model.senseDepth(depth_m, {}, 1, mm);
  std::ranges::sort(mm);
  mm.erase(std::ranges::unique(mm).begin(), mm.end());
  // From 3 to 3.5 m the disparity goes from 14.25 to 12.2 px: 17 steps of an eighth.
  EXPECT_GE(mm.size(), 16u);
  EXPECT_LE(mm.size(), 19u);
}

TEST(SensorModel, CastsTheProjectorsShadowLeftOfWhatIsNear) {
  const RgbdFormat format = {.width_px = 640, .height_px = 16};
  SensorModel model({}, format);
  std::vector<float> depth_m(format.pixels(), 4);
  for (std::size_t i = 0; i < depth_m.size(); ++i)
    if (i % 640 >= 300 && i % 640 < 400) depth_m[i] = 2;
  std::vector<std::uint16_t> mm(format.pixels());
  model.senseDepth(depth_m, {}, 1, mm);
  const auto holes = [&mm](std::size_t from, std::size_t to) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < mm.size(); ++i)
      if (i % 640 >= from && i % 640 < to && mm[i] == 0) ++count;
    return static_cast<double>(count) / (16.0 * static_cast<double>(to - from));
  };
  // 570 px * 75 mm * (1 / 2 m - 1 / 4 m) = 10.7 px.
  EXPECT_GT(holes(291, 299), 0.8);
  EXPECT_LT(holes(270, 287), 0.05);
  EXPECT_LT(holes(302, 440), 0.05);
}

TEST(SensorModel, LosesWhatIsDarkAndFar) {
  const RgbdFormat format = {.width_px = 640, .height_px = 100};
  SensorModel model({}, format);
  const std::vector<float> depth_m(format.pixels(), 7);
  std::vector<std::uint16_t> mm(format.pixels());
  const auto measured = [&](std::uint8_t brightness) {
    const std::vector<std::uint8_t> rgb(3 * format.pixels(), brightness);
    model.senseDepth(depth_m, rgb, 1, mm);
    return mm.size() - static_cast<std::size_t>(std::ranges::count(mm, 0));
  };
  EXPECT_LT(static_cast<double>(measured(0)), 0.9 * static_cast<double>(measured(200)));
}

TEST(SensorModel, IsAFunctionOfPictureNumberAndSeed) {
  const RgbdFormat format = {.width_px = 320, .height_px = 240, .focal_px = 285};
  const emulator::PracticeRoom room(format);
  std::vector<float> depth_m(format.pixels());
  std::vector<std::uint8_t> rgb(3 * format.pixels());
  room.draw(1.5, false, {depth_m, rgb});
  const auto sensed = [&](std::uint64_t seed, std::uint64_t number) {
    SensorModel model({.seed = seed}, format);
    std::vector<std::uint16_t> mm(format.pixels());
    model.senseDepth(depth_m, rgb, number, mm);
    return mm;
  };
  EXPECT_EQ(sensed(1, 7), sensed(1, 7));
  EXPECT_NE(sensed(1, 7), sensed(1, 8));
  EXPECT_NE(sensed(1, 7), sensed(2, 7));
}

TEST(SensorModel, ShiftsDepthWhereNobodyRegistersIt) {
  const RgbdFormat format = {.width_px = 640, .height_px = 16};
  const SensorModel model({.colour_baseline_m = 0.025}, format);
  std::vector<std::uint16_t> registered(format.pixels(), 0);
  registered[100] = 1425;  // 570 px * 25 mm / 1425 mm = 10 px
  std::vector<std::uint16_t> raw(format.pixels());
  model.unregister(registered, raw);
  EXPECT_EQ(raw[110], 1425);
  EXPECT_EQ(std::ranges::count(raw, 0), static_cast<std::ptrdiff_t>(raw.size()) - 1);
}

}  // namespace

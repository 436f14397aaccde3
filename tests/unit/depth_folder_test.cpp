// Recordings as folders of pictures: what is written is read, and what is wrong is named.

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/openni/folder_recording.h"
#include "hal/openni/folder_sensor.h"
#include "hal/openni/folder_writer.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using hal::DepthState;
using hal::openni::ColourFile;
using hal::openni::FolderRecording;
using hal::openni::FolderSensor;
using hal::openni::FolderWriter;
using hal::openni::Play;
using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr std::uint32_t kWidth = 32;
constexpr std::uint32_t kHeight = 24;
constexpr std::array<double, 5> kDistortion = {0.1, -0.05, 0.001, -0.002, 0.03};

class Folder : public testing::Test {
 public:
  /// Five pictures, the third of which was lost.
  void write(ColourFile colour = ColourFile::kPng, bool with_colour = true) {
    FolderWriter writer(folder_, colour);
    for (const std::uint64_t number : {11U, 12U, 14U, 15U}) {
      const auto depth_mm = depthOf(number);
      const auto rgb = colourOf(number);
      const auto written =
          writer.write({.depth_mm = depth_mm,
                        .colour_rgb = with_colour ? std::span<const std::uint8_t>(rgb)
                                                  : std::span<const std::uint8_t>(),
                        .width_px = kWidth,
                        .height_px = kHeight,
                        .lens = {28.5, 28.25, 15.5, 11.5, kDistortion},
                        .number = number,
                        .exposure = rt::fromNs(static_cast<std::int64_t>(number) * 33'333'000)},
                       "a \"sensor\"");
      ASSERT_TRUE(written) << written.error();
    }
  }
  static std::vector<std::uint16_t> depthOf(std::uint64_t number) {
    std::vector<std::uint16_t> mm(std::size_t{kWidth} * kHeight);
    for (std::size_t i = 0; i < mm.size(); ++i)
      mm[i] = static_cast<std::uint16_t>(i % 7 == 0 ? 0 : 100 * number + 60 * i);
    return mm;
  }
  static std::vector<std::uint8_t> colourOf(std::uint64_t number) {
    std::vector<std::uint8_t> rgb(std::size_t{3} * kWidth * kHeight);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(number + i);
    return rgb;
  }
  [[nodiscard]] std::string refusal() const {
    const auto recording = FolderRecording::open(folder_);
    return recording ? "opened" : recording.error();
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  test::TemporaryFolder scratch_;
  fs::path folder_ = scratch_ / "recording";
};

TEST_F(Folder, IsReadAsItWasWritten) {
  write();
  const auto recording = FolderRecording::open(folder_);
  ASSERT_TRUE(recording) << recording.error();
  EXPECT_EQ(recording->name(), "a \"sensor\"");
  EXPECT_EQ(recording->width_px(), kWidth);
  EXPECT_DOUBLE_EQ(recording->lens().focal_y_px, 28.25);
  EXPECT_DOUBLE_EQ(recording->lens().centre_x_px, 15.5);
  EXPECT_EQ(recording->lens().distortion, kDistortion);
  ASSERT_EQ(recording->entries().size(), 4u);
  for (const auto& entry : recording->entries()) {
    EXPECT_EQ(entry.stamp_us, 33'333 * (entry.number - 11));
    const auto pictures = recording->read(entry);
    ASSERT_TRUE(pictures) << pictures.error();
    EXPECT_EQ(pictures->depth_mm, depthOf(entry.number));
    EXPECT_EQ(pictures->colour_rgb, colourOf(entry.number));
  }
}

TEST_F(Folder, CountsWhatIsMissing) {
  write(ColourFile::kJpeg);
  put("depth/000012.png", "broken");
  auto sensor = FolderSensor::open({.folder = folder_, .play = Play::kEveryFrame, .repeat = false});
  ASSERT_TRUE(sensor) << sensor.error();
  std::vector<std::uint64_t> numbers;
  while (const auto frame = (*sensor)->waitFrame(1ms)) numbers.push_back(frame->number);
  EXPECT_THAT(numbers, testing::ElementsAre(11, 14, 15));
  const auto status = (*sensor)->status();
  EXPECT_EQ(status.state, DepthState::kEnded);
  EXPECT_EQ(status.lost, 2u);
  EXPECT_THAT(status.message, HasSubstr("000012.png: not a 16-bit grey PNG of 32x24"));
}

TEST_F(Folder, TakesPicturesOfAnotherSizeForLost) {
  write();
  const std::vector<std::uint16_t> smaller(std::size_t{16} * 12, 1000);
  const std::vector<std::uint8_t> none;
  const fs::path other = scratch_ / "other";
  FolderWriter writer(other, ColourFile::kPng);
  ASSERT_TRUE(writer.write({.depth_mm = smaller,
                            .colour_rgb = none,
                            .width_px = 16,
                            .height_px = 12,
                            .lens = {14, 14, 7.5, 5.5},
                            .number = 12},
                           "x"));
  fs::copy_file(other / "depth" / "000012.png", folder_ / "depth" / "000012.png",
                fs::copy_options::overwrite_existing);
  auto sensor = FolderSensor::open({.folder = folder_, .play = Play::kEveryFrame, .repeat = false});
  ASSERT_TRUE(sensor) << sensor.error();
  int frames = 0;
  while ((*sensor)->waitFrame(1ms)) ++frames;
  EXPECT_EQ(frames, 3);
  EXPECT_EQ((*sensor)->status().lost, 2u);
  EXPECT_THAT((*sensor)->status().message, HasSubstr("000012.png: not a 16-bit grey PNG of 32x24"));
}

TEST_F(Folder, IsPlayedAsFastAsItWasTaken) {
  write();
  auto sensor = FolderSensor::open({.folder = folder_, .repeat = false});
  ASSERT_TRUE(sensor) << sensor.error();
  const auto first = (*sensor)->waitFrame(10s);
  ASSERT_TRUE(first);
  const rt::Timestamp began = first->exposure;
  auto last = first;
  while (const auto frame = (*sensor)->waitFrame(1s)) last = frame;
  EXPECT_EQ(last->exposure - began, 4 * 33'333us);
  EXPECT_GE(rt::now() - began, 4 * 33'333us);
}

TEST_F(Folder, WithoutColourHasDepthAlone) {
  write(ColourFile::kPng, false);
  auto sensor = FolderSensor::open({.folder = folder_, .play = Play::kEveryFrame});
  ASSERT_TRUE(sensor) << sensor.error();
  const auto frame = (*sensor)->waitFrame(10s);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->colour_rgb.empty());
  EXPECT_FALSE((*sensor)->status().colour);
  EXPECT_EQ((*sensor)->status().without_colour, 0u);
}

TEST_F(Folder, GoesOnWhereOneColourIsMissingOrBroken) {
  write();
  fs::remove(folder_ / "colour" / "000012.png");
  put("colour/000014.png", "broken");
  auto sensor = FolderSensor::open({.folder = folder_, .play = Play::kEveryFrame, .repeat = false});
  ASSERT_TRUE(sensor) << sensor.error();
  int frames = 0;
  while ((*sensor)->waitFrame(1ms)) ++frames;
  EXPECT_EQ(frames, 4);
  EXPECT_EQ((*sensor)->status().without_colour, 2u);
  EXPECT_THAT((*sensor)->status().message, HasSubstr("000014.png: not a picture of 32x24"));
}

TEST_F(Folder, RepeatsWhereAsked) {
  write();
  auto sensor = FolderSensor::open({.folder = folder_, .play = Play::kEveryFrame});
  ASSERT_TRUE(sensor) << sensor.error();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE((*sensor)->waitFrame(10s));
  EXPECT_EQ((*sensor)->status().state, DepthState::kStreaming);
  EXPECT_EQ((*sensor)->status().lost, 2u) << "picture 13, each time it was passed";
}

TEST_F(Folder, WithoutOnePictureThatCanBeReadEnds) {
  write();
  for (const int number : {11, 12, 14, 15})
    put("depth/0000" + std::to_string(number) + ".png", "broken");
  auto sensor = FolderSensor::open({.folder = folder_, .play = Play::kEveryFrame});
  ASSERT_TRUE(sensor) << sensor.error();
  EXPECT_FALSE((*sensor)->waitFrame(1ms));
  EXPECT_EQ((*sensor)->status().state, DepthState::kEnded);
}

TEST_F(Folder, ThatIsWrongIsRefusedInOneLine) {
  EXPECT_THAT(refusal(), HasSubstr("there is no such folder"));
  fs::create_directories(folder_ / "depth");
  EXPECT_THAT(refusal(), HasSubstr("sensor.toml"));
  put("sensor.toml", "format = 2");
  EXPECT_THAT(refusal(), HasSubstr("format must be 1"));
  put("sensor.toml", "format = 1\nsize_px = [32, 24]");
  EXPECT_THAT(refusal(), HasSubstr("focal_px"));
  put("sensor.toml", "format = 1\nsize_px = [32, -24]\nfocal_px = [28, 28]");
  EXPECT_THAT(refusal(), HasSubstr("size_px"));
  put("sensor.toml", "format = 1\nsize_px = [32, 24]\nfocal_px = [nan, 28]");
  EXPECT_THAT(refusal(), HasSubstr("focal_px"));
  put("sensor.toml", "format = 1\nsize_px = [32, 24]\nfocal_px = [28, 28]\nrate_hz = 0");
  EXPECT_THAT(refusal(), HasSubstr("rate_hz"));
  put("sensor.toml", "format = 1\nsize_px = [32, 24]\nfocal_px = [28, 28]");
  EXPECT_THAT(refusal(), HasSubstr("holds no picture"));
  put("sensor.toml", "format = [");
  EXPECT_THAT(refusal(), HasSubstr("sensor.toml"));
  EXPECT_EQ(refusal().find('\n'), std::string::npos);
}

TEST_F(Folder, StampsThatAreWrongAreRefused) {
  write();
  put("stamps.csv", "number,stamp_us\n11,0\nx,y\n");
  EXPECT_THAT(refusal(), HasSubstr("stamps.csv:3: must be two whole numbers"));
  put("stamps.csv", "number,stamp_us\n11,0\n");
  EXPECT_THAT(refusal(), HasSubstr("has no line for picture 12"));
  fs::remove(folder_ / "stamps.csv");
  const auto recording = FolderRecording::open(folder_);
  ASSERT_TRUE(recording) << recording.error();
  EXPECT_EQ(recording->entries()[1].stamp_us, 33'333u) << "evenly, 30 a second";
}

TEST_F(Folder, IsNotWrittenOverAnother) {
  write();
  FolderWriter writer(folder_, ColourFile::kPng);
  const auto depth_mm = depthOf(1);
  const auto written =
      writer.write({.depth_mm = depth_mm, .width_px = kWidth, .height_px = kHeight}, "x");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("is not empty"));
}

}  // namespace

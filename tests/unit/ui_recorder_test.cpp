#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/temporary_folder.h"
#include "ui-kms/film.h"
#include "ui-kms/recorder.h"

namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t kWidthPx = 128;
constexpr std::uint32_t kHeightPx = 72;

/// A screen of one colour.
class PlainPicture final : public ui::PictureSource {
 public:
  rt::Result<void> readPicture(std::span<std::byte> rgba) override {
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      rgba[i] = std::byte{red};
      rgba[i + 1] = std::byte{60};
      rgba[i + 2] = std::byte{20};
      rgba[i + 3] = std::byte{255};
    }
    return {};
  }
  std::optional<hal::PageFlip> committedFlip() const override { return flip; }

  std::uint8_t red = 0;
  std::optional<hal::PageFlip> flip;
};

class RecorderTest : public testing::Test {
 protected:
  std::unique_ptr<ui::Recorder> makeRecorder(double video_hz, std::uint32_t buffers = 6) {
    auto recorder = ui::Recorder::create({folder_.path(), 64, video_hz, buffers},
                                         {kWidthPx, kHeightPx, 60}, source_);
    EXPECT_TRUE(recorder) << recorder.error();
    return recorder ? std::move(*recorder) : nullptr;
  }

  static ui::PictureStamp stampAt(std::uint64_t id, milliseconds at) {
    ui::PictureStamp stamp;
    stamp.picture_id = id;
    std::ranges::copy(std::string_view("delayed"), stamp.mode.begin());
    stamp.camera = 6;
    stamp.trigger = 100 + id;
    stamp.commit = rt::Timestamp(at);
    stamp.H_camera_display = {1, 0, 0.1, 0, 1, 0, 0, 0, 1};
    return stamp;
  }

  /// Keeps what the film wants of @p pictures pictures, @p apart from each other, none dropped.
  void keepAll(ui::Recorder& recorder, int pictures, milliseconds apart) {
    for (int i = 0; i < pictures; ++i) {
      source_.red = static_cast<std::uint8_t>(i * 255 / pictures);
      recorder.keep(stampAt(static_cast<std::uint64_t>(i), i * apart + milliseconds(1'000)));
      std::this_thread::sleep_for(milliseconds(2));  // the writer is faster than that
    }
  }

  [[nodiscard]] std::vector<std::string> lines() const {
    std::ifstream file(folder_ / "pictures.jsonl");
    std::vector<std::string> all;
    for (std::string line; std::getline(file, line);) all.push_back(line);
    return all;
  }

  test::TemporaryFolder folder_;
  PlainPicture source_;
};

TEST_F(RecorderTest, KeepsTheFilmAtItsOwnRate) {
  const auto recorder = makeRecorder(20, 16);
  keepAll(*recorder, 40, milliseconds(25));  // shown at 40 Hz for a second
  const auto cost = recorder->finish();
  ASSERT_TRUE(cost) << cost.error();
  EXPECT_EQ(cost->frames + cost->dropped, 20U);
  EXPECT_GT(cost->render_thread_ns, 0);
  EXPECT_GT(cost->writer_cpu_ns, 0);
  EXPECT_EQ(lines().size(), cost->frames);
}

TEST_F(RecorderTest, WritesWhatIsKnownOfAPicture) {
  const auto recorder = makeRecorder(20);
  source_.flip = hal::PageFlip{9, rt::fromNs(77), 1};
  recorder->keep(stampAt(9, milliseconds(5)), "freeze");
  ASSERT_TRUE(recorder->finish());
  ASSERT_EQ(lines().size(), 1U);
  EXPECT_EQ(lines()[0],
            R"({"picture_id":9,"mode":"delayed","camera":6,"trigger":109,"commit_ns":5000000,)"
            R"("page_flip_ns":77,"film_picture":0,"still":"freeze.png",)"
            R"("H_camera_display":[1,0,0.10000000000000001,0,1,0,0,0,1],"focal_px":[0,0],)"
            R"("centre_px":[0,0],"distortion":[0,0,0,0,0],"max_radius":[0]})");
}

TEST_F(RecorderTest, AFlipOfAnotherPictureIsNotClaimed) {
  const auto recorder = makeRecorder(20);
  source_.flip = hal::PageFlip{8, rt::fromNs(77), 1};
  recorder->keep(stampAt(9, milliseconds(5)));
  ASSERT_TRUE(recorder->finish());
  EXPECT_NE(lines().at(0).find("\"page_flip_ns\":null"), std::string::npos);
}

TEST_F(RecorderTest, AStillIsWholeAndInTheRightColours) {
  const auto recorder = makeRecorder(20);
  source_.red = 200;
  recorder->keep(stampAt(1, milliseconds(5)), "live");
  ASSERT_TRUE(recorder->finish());
  const cv::Mat still = cv::imread((folder_ / "live.png").string());
  ASSERT_EQ(still.size(), cv::Size(kWidthPx, kHeightPx));
  EXPECT_EQ(still.at<cv::Vec3b>(10, 10), cv::Vec3b(20, 60, 200));  // OpenCV: blue first
  EXPECT_FALSE(std::filesystem::exists(folder_ / "live.rgba"));
}

TEST_F(RecorderTest, ADroppedPictureIsCountedAndTheRenderThreadNeverWaits) {
  const auto recorder = makeRecorder(1'000, 1);
  constexpr int kPictures = 300;
  for (int i = 0; i < kPictures; ++i) {
    recorder->keep(stampAt(static_cast<std::uint64_t>(i), milliseconds(i + 1)));
  }
  const auto cost = recorder->finish();
  ASSERT_TRUE(cost);
  EXPECT_EQ(cost->frames + cost->dropped, kPictures);
  EXPECT_EQ(lines().size(), cost->frames);
}

TEST_F(RecorderTest, AFolderThatIsNotThereIsNamed) {
  const auto recorder =
      ui::Recorder::create({folder_ / "none"}, {kWidthPx, kHeightPx, 60}, source_);
  ASSERT_FALSE(recorder);
  EXPECT_NE(recorder.error().find("none/video.film"), std::string::npos);
}

TEST_F(RecorderTest, TheVideoPlaysForAsLongAsThePicturesStood) {
  const auto recorder = makeRecorder(20, 16);
  keepAll(*recorder, 32, milliseconds(25));  // as many for the film as there are buffers
  ASSERT_TRUE(recorder->finish());
  const std::filesystem::path video = folder_ / "demo.mp4";
  const auto film = ui::encodeVideo(folder_ / "video.film", video);
  ASSERT_TRUE(film) << film.error();
  EXPECT_NEAR(static_cast<double>(film->frames) / film->hz, 0.8, 0.06);

  cv::VideoCapture player(video.string());
  ASSERT_TRUE(player.isOpened());
  EXPECT_DOUBLE_EQ(player.get(cv::CAP_PROP_FPS), 20);
  cv::Mat frame;
  cv::Mat last;
  std::uint64_t frames = 0;
  double first_red = 0;
  while (player.read(frame)) {
    if (frames++ == 0) first_red = cv::mean(frame)[2];
    frame.copyTo(last);
  }
  EXPECT_EQ(frames, film->frames);
  EXPECT_EQ(last.size(), cv::Size(64, 36));
  EXPECT_NEAR(first_red, 0, 12);  // lossy, and colour at half size
  EXPECT_NEAR(cv::mean(last)[2], 239, 14);
}

TEST_F(RecorderTest, ARecordingThatWasCutOffEndsAtItsLastWholePicture) {
  const auto recorder = makeRecorder(20, 16);
  keepAll(*recorder, 8, milliseconds(50));
  ASSERT_TRUE(recorder->finish());
  const std::filesystem::path side = folder_ / "video.film";
  std::filesystem::resize_file(side, std::filesystem::file_size(side) - 100);
  const auto film = ui::encodeVideo(side, folder_ / "demo.mp4");
  ASSERT_TRUE(film) << film.error();
  EXPECT_EQ(film->pictures + 1, lines().size());
}

TEST_F(RecorderTest, WhatIsNoRecordingIsRefused) {
  const std::filesystem::path side = folder_ / "other.film";
  for (const char* content : {"", "kagami-film 2 64 36 20\n", "kagami-film 1 0 36 20\n",
                              "kagami-film 1 64 36 -1\n", "kagami-film 1 64 36 20\n"}) {
    std::ofstream(side) << content;
    EXPECT_FALSE(ui::encodeVideo(side, folder_ / "demo.mp4")) << content;
  }
  EXPECT_FALSE(ui::encodeVideo(folder_ / "none", folder_ / "demo.mp4"));
}

TEST_F(RecorderTest, AContactSheetHoldsEveryStill) {
  std::vector<ui::CaptionedStill> stills;
  for (int i = 0; i < 5; ++i) {
    const std::filesystem::path png = folder_ / (std::to_string(i) + ".png");
    cv::imwrite(png.string(), cv::Mat(kHeightPx, kWidthPx, CV_8UC3, cv::Scalar(0, 0, 50 * i + 50)));
    stills.push_back({png, "still " + std::to_string(i)});
  }
  const std::filesystem::path sheet = folder_ / "sheet.png";
  const auto made = ui::contactSheet(stills, sheet);
  ASSERT_TRUE(made) << made.error();
  const cv::Mat page = cv::imread(sheet.string());
  for (int i = 0; i < 5; ++i) {
    cv::Mat of_this_still;
    cv::inRange(page, cv::Scalar(0, 0, 50 * i + 50), cv::Scalar(0, 0, 50 * i + 50), of_this_still);
    EXPECT_EQ(cv::countNonZero(of_this_still), 640 * 360) << i;
  }
  stills[2].png = folder_ / "gone.png";
  const auto missing = ui::contactSheet(stills, sheet);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("gone.png"), std::string::npos);
}

}  // namespace

// The depth sensor's pictures of the studio as they are put together, kept and read again.
#include <vector>

#include <gtest/gtest.h>

#include "hal/emulated/studio/depth_sensor.h"
#include "hal/emulated/studio/rgbd_view.h"

namespace {

using namespace emulator::studio;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

StudioCamera small() {
  StudioCamera camera = makeDepthSensor(1);
  camera.model.image_size = {kWidth, kHeight};
  camera.model.focal_px = {38, 38};
  camera.model.centre_px = {31.5, 23.5};
  return camera;
}

/// A wall 6 m away, of middle grey.
Backdrop wall() {
  return {.width = kWidth,
          .height = kHeight,
          .rgb = std::vector<float>(std::size_t{3} * kWidth * kHeight, 0.2f),
          .ripple = std::vector<float>(std::size_t{kWidth} * kHeight),
          .depth_m = std::vector<float>(std::size_t{kWidth} * kHeight, 6.0f)};
}

FloorShade noShade() {
  return {.share = cv::Mat(FloorShade::kRows, FloorShade::kColumns, CV_32F, cv::Scalar(1))};
}

struct Picture {
  std::vector<float> depth_m = std::vector<float>(std::size_t{kWidth} * kHeight);
  std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(std::size_t{3} * kWidth * kHeight);
  emulator::DepthRingWriter::Canvas canvas() { return {depth_m, rgb}; }
};

/// A white board 2 m away in a corner of the picture.
RgbdPatch boardBefore(const RgbdView& view) {
  const cv::Rect place(4, 6, 10, 8);
  cv::Mat depth(kHeight, kWidth, CV_32F, cv::Scalar(6));
  depth(place).setTo(2.0);
  return view.develop(
      {{.area = place, .roots = cv::Mat(place.size(), CV_8UC4, cv::Scalar::all(255))}}, noShade(),
      depth);
}

TEST(RgbdView, PutsPeopleBeforeTheHallInDepthAndColourAlike) {
  const RgbdView view(small(), wall());
  Picture picture;
  view.drawEmpty(picture.canvas());
  boardBefore(view).putInto(picture.canvas());
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool board = cv::Rect(4, 6, 10, 8).contains(cv::Point(x, y));
      const std::size_t i = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
      ASSERT_NEAR(picture.depth_m[i], board ? 2 : 6, 2e-4) << x << "," << y;
      ASSERT_EQ(picture.rgb[3 * i] > 250, board) << x << "," << y;
    }
  }
}

TEST(RgbdView, IsTheSameAfterItWasKept) {
  const RgbdView view(small(), wall());
  std::vector<std::byte> bytes;
  view.save(bytes);
  ASSERT_EQ(bytes.size(), RgbdView::savedBytes({kWidth, kHeight}));
  const RgbdView read(small(), bytes);
  Picture a;
  Picture b;
  view.drawEmpty(a.canvas());
  read.drawEmpty(b.canvas());
  EXPECT_EQ(a.depth_m, b.depth_m);
  EXPECT_EQ(a.rgb, b.rgb);
}

TEST(RgbdPatch, IsReadAsItWasSavedAndRefusedWhereItIsDamaged) {
  const RgbdView view(small(), wall());
  const RgbdPatch patch = boardBefore(view);
  std::vector<std::byte> bytes;
  patch.save(bytes);
  std::span<const std::byte> all(bytes);
  const auto read = RgbdPatch::load(all, kWidth * kHeight);
  ASSERT_TRUE(read);
  EXPECT_TRUE(all.empty());
  EXPECT_EQ(read->depth_steps, patch.depth_steps);
  EXPECT_EQ(read->colour_rgb, patch.colour_rgb);
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    std::span<const std::byte> cut(bytes.data(), size);
    EXPECT_FALSE(RgbdPatch::load(cut, kWidth * kHeight)) << size;
  }
  std::span<const std::byte> smaller(bytes);
  EXPECT_FALSE(RgbdPatch::load(smaller, 100)) << "runs beyond the picture";
}

}  // namespace

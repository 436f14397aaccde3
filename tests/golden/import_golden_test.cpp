#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <unistd.h>

#include "rt/dma_buf.h"
#include "rt/memory.h"
#include "tests/golden/synthetic_scene.h"
#include "ui-kms/offscreen_display.h"

namespace {

const cv::Size kFrame(1280, 1024);
const cv::Size kDisplay(640, 360);
constexpr std::size_t kSlots = 3;

using Picture = std::vector<std::byte>;

std::ptrdiff_t differingPixels(const Picture& a, const Picture& b) {
  std::ptrdiff_t differing = 0;
  for (std::size_t i = 0; i < a.size(); i += 4) {
    if (!std::equal(&a[i], &a[i] + 4, &b[i])) ++differing;
  }
  return differing;
}

std::unique_ptr<ui::OffscreenDisplay> makeDisplay(ui::DemosaicSite site, cv::Size frame = kFrame) {
  ui::OffscreenConfig config;
  config.renderer.width_px = static_cast<std::uint32_t>(kDisplay.width);
  config.renderer.height_px = static_cast<std::uint32_t>(kDisplay.height);
  if (!frame.empty()) {
    config.renderer.sources = {
        {static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height)}};
  }
  config.renderer.demosaic = site;
  config.refresh_hz = 1000;
  auto display = ui::OffscreenDisplay::create(config);
  EXPECT_TRUE(display) << display.error();
  return display ? std::move(*display) : nullptr;
}

/// A turned, magnified view with a distorted lens, so that every pixel is interpolated.
hal::WarpPlan planOf(const hal::SourceImage& source) {
  hal::WarpPlan plan;
  plan.source = source;
  plan.H_camera_display = {1.7, -0.3, 120, 0.25, 1.8, 90, 1e-4, -5e-5, 1};
  plan.lens = {.fx_px = 1180,
               .fy_px = 1175,
               .cx_px = (source.width_px - 1) / 2.0,
               .cy_px = (source.height_px - 1) / 2.0,
               .distortion = {-0.12, 0.03, 0.001, -0.0008, 0},
               .max_radius = std::numeric_limits<double>::infinity()};
  plan.colour.gain_rgb = {1.4F, 1.0F, 0.8F};
  return plan;
}

struct Shown {
  Picture picture = Picture(std::size_t{4} * 640 * 360);
  bool imported = false;
};

Shown show(ui::OffscreenDisplay& display, const hal::SourceImage& source) {
  Shown shown;
  const auto instants =
      display.render({.layers = {hal::ViewLayer{.plan = planOf(source)}}, .count = 1});
  EXPECT_TRUE(instants);
  shown.imported = instants && instants->imported;
  // A vblank of 1 ms may have to pass since the last picture.
  const rt::Timestamp patience = rt::now() + std::chrono::seconds(60);
  while (!display.commit(1) && rt::now() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(display.readPicture(shown.picture));
  return shown;
}

/// The scene with a part of its light.
cv::Mat3b dimmed(const cv::Mat3b& scene, double part) {
  cv::Mat3b dim;
  scene.convertTo(dim, -1, part);
  return dim;
}

hal::SourceImage uploaded(hal::SourceImage source) {
  source.dma_buf = {};
  return source;
}

/// Frames as the history keeps them, in slots of one dma-buf, on a machine whose renderer reads
/// them there.
class ImportGolden : public testing::Test {
 protected:
  void SetUp() override {
    const auto page_bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    slot_bytes_ = (frame_bytes_ + page_bytes - 1) / page_bytes * page_bytes;
    auto arena = rt::LockedArena::create(kSlots * slot_bytes_, 0, rt::ArenaBacking::kMemoryFile);
    ASSERT_TRUE(arena) << arena.error().where;
    arena_ = std::move(*arena);
    auto buffer = rt::DmaBuf::create(arena_.memoryFile(), 0, kSlots * slot_bytes_);
    display_ = makeDisplay(ui::DemosaicSite::kGpu);
    ASSERT_NE(display_, nullptr);
    const std::string reason(display_->uploadReason());
    if (!reason.empty()) {
      // A GPU may require a pitch that this frame does not have; the CPU requires none.
      const bool none_offered = !buffer || reason.find(" lists no ") != std::string::npos;
      EXPECT_TRUE(none_offered || display_->renderer().find("llvmpipe") == std::string_view::npos)
          << reason;
      GTEST_SKIP() << "frames are uploaded here: " << reason;
    }
    ASSERT_TRUE(buffer) << buffer.error().where;  // the display made one
    buffer_.emplace(std::move(*buffer));
  }

  /// Writes a frame into a slot, as a camera does.
  hal::SourceImage store(std::size_t slot, const cv::Mat3b& scene,
                         hal::PixelFormat format = hal::PixelFormat::kBayerRG8) {
    const std::vector<std::byte> mosaic = mosaicOf(scene, format);
    const auto pixels = arena_.bytes().subspan(slot * slot_bytes_, frame_bytes_);
    std::ranges::copy(mosaic, pixels.begin());
    return {.pixels = pixels.data(),
            .width_px = static_cast<std::uint32_t>(kFrame.width),
            .height_px = static_cast<std::uint32_t>(kFrame.height),
            .format = format,
            .dma_buf = buffer_->part(slot * slot_bytes_)};
  }

  void expectBothPathsEqual(const hal::SourceImage& source) {
    const Shown imported = show(*display_, source);
    const Shown copied = show(*display_, uploaded(source));
    EXPECT_TRUE(imported.imported);
    EXPECT_FALSE(copied.imported);
    EXPECT_EQ(differingPixels(imported.picture, copied.picture), 0);
  }

  std::size_t frame_bytes_ = static_cast<std::size_t>(kFrame.area());
  std::size_t slot_bytes_ = 0;
  rt::LockedArena arena_;
  std::optional<rt::DmaBuf> buffer_;
  std::unique_ptr<ui::OffscreenDisplay> display_;
};

TEST_F(ImportGolden, BothPathsGiveTheSamePixelsForEveryFormat) {
  using enum hal::PixelFormat;
  const cv::Mat3b scene = syntheticScene(kFrame);
  for (const auto format : {kBayerRG8, kBayerGB8, kBayerGR8, kBayerBG8, kMono8}) {
    SCOPED_TRACE(static_cast<int>(format));
    expectBothPathsEqual(store(1, scene, format));
  }
}

TEST_F(ImportGolden, EverySlotShowsItsOwnFrame) {
  const cv::Mat3b scene = syntheticScene(kFrame);
  std::vector<hal::SourceImage> sources;
  std::vector<Picture> pictures;
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    sources.push_back(store(slot, dimmed(scene, 1.0 / static_cast<double>(slot + 1))));
    expectBothPathsEqual(sources.back());
    pictures.push_back(show(*display_, sources.back()).picture);
  }
  for (std::size_t slot = kSlots; slot-- > 0;) {  // once more, the other way round
    EXPECT_EQ(differingPixels(show(*display_, sources[slot]).picture, pictures[slot]), 0);
  }
  EXPECT_GT(differingPixels(pictures[0], pictures[1]), kDisplay.area() / 2);
}

TEST_F(ImportGolden, ASlotThatIsWrittenAgainShowsItsNewFrame) {
  const cv::Mat3b scene = syntheticScene(kFrame);
  const Picture first = show(*display_, store(2, scene)).picture;
  for (const double part : {0.5, 0.3, 0.8}) {
    const hal::SourceImage source = store(2, dimmed(scene, part));
    expectBothPathsEqual(source);
    EXPECT_GT(differingPixels(show(*display_, source).picture, first), kDisplay.area() / 2);
  }
}

TEST_F(ImportGolden, AFrameThatTheDriverRefusesIsUploaded) {
  hal::SourceImage source = store(0, syntheticScene(kFrame));
  const Picture right = show(*display_, source).picture;
  source.dma_buf = {.fd = STDERR_FILENO, .buffer = 1'000'000, .offset_bytes = 0};  // no dma-buf
  for (int again = 0; again < 2; ++again) {
    const Shown shown = show(*display_, source);
    EXPECT_FALSE(shown.imported);
    EXPECT_EQ(differingPixels(shown.picture, right), 0);
  }
  expectBothPathsEqual(store(0, syntheticScene(kFrame)));  // others are still imported
}

/// What holds on every machine.
TEST(UploadReason, IsTheCpusWhereTheCpuDemosaics) {
  const auto display = makeDisplay(ui::DemosaicSite::kCpu);
  ASSERT_NE(display, nullptr);
  EXPECT_EQ(display->uploadReason(), "the CPU demosaics");
}

TEST(UploadReason, IsGivenWhereTheFramesSizeIsNotKnown) {
  const auto display = makeDisplay(ui::DemosaicSite::kGpu, {0, 0});
  ASSERT_NE(display, nullptr);
  EXPECT_FALSE(display->uploadReason().empty());
}

TEST(UploadReason, IsOneLineAndThenDmaBufsChangeNothing) {
  const auto display = makeDisplay(ui::DemosaicSite::kGpu);
  ASSERT_NE(display, nullptr);
  if (display->uploadReason().empty()) GTEST_SKIP() << "frames are read in place here";
  EXPECT_EQ(display->uploadReason().find('\n'), std::string_view::npos);
  const std::vector<std::byte> mosaic =
      mosaicOf(syntheticScene(kFrame), hal::PixelFormat::kBayerRG8);
  hal::SourceImage source{.pixels = mosaic.data(),
                          .width_px = static_cast<std::uint32_t>(kFrame.width),
                          .height_px = static_cast<std::uint32_t>(kFrame.height)};
  const Picture right = show(*display, source).picture;
  source.dma_buf = {.fd = STDERR_FILENO, .buffer = 1};
  const Shown shown = show(*display, source);
  EXPECT_FALSE(shown.imported);
  EXPECT_EQ(differingPixels(shown.picture, right), 0);
}

}  // namespace

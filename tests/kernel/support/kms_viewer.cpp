#include "tests/kernel/support/kms_viewer.h"

#include <thread>
#include <utility>

#include <gtest/gtest.h>

namespace test {
namespace {

constexpr std::uint32_t kWidthPx = 64;
constexpr std::uint32_t kHeightPx = 48;
constexpr std::chrono::milliseconds kPause{1};  // never a spin: in virtual time nothing would move

}  // namespace

ui::KmsConfig KmsViewer::quick(const std::string& card) {
  ui::KmsConfig config;
  config.device = card;
  config.mode = "640x480";
  return config;
}

KmsViewer::KmsViewer(const ui::KmsConfig& config) : pixels_(std::size_t{kWidthPx} * kHeightPx) {
  auto display = ui::KmsDisplay::create(config);
  if (!display) {
    ADD_FAILURE() << display.error();
    return;
  }
  display_ = std::move(*display);
}

rt::Result<rt::Timestamp> KmsViewer::tryShow() {
  ++pictures_;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    pixels_[i] = static_cast<std::byte>(i * 37 + pictures_ * 11 + (i / kWidthPx) * pictures_);
  }
  const hal::DisplayMode mode = display_->mode();
  hal::Scene scene{.count = 1};
  hal::WarpPlan& plan = scene.layers[0].plan;
  plan.source = {
      .pixels = pixels_.data(), .width_px = kWidthPx, .height_px = kHeightPx, .dma_buf = {}};
  // A little smaller than the screen and turned, so that all kinds of pixels occur: inside, along
  // slanting borders and outside.
  const double scale = 1.1 * kWidthPx / mode.width_px;
  plan.H_camera_display = {scale, 0.1 * scale, -2, -0.1 * scale, scale, 1, 0, 0, 1};
  plan.lens = {.fx_px = 50, .fy_px = 50, .cx_px = 31.5, .cy_px = 23.5, .max_radius = 10};
  const auto drawn = display_->render(scene);
  if (!drawn) return std::unexpected(drawn.error());
  return display_->commit(pictures_);
}

std::optional<hal::PageFlip> KmsViewer::show(rt::Nanoseconds patience) {
  const rt::Timestamp end = rt::now() + patience;
  bool committed = false;
  std::uint64_t changes = 0;
  while (rt::now() < end) {
    if (committed && display_->screen().changes != changes) committed = false;
    if (!committed && tryShow()) {
      committed = true;
      changes = display_->screen().changes;
    }
    while (const auto flip = display_->tryPopFlip()) {
      if (committed && flip->picture_id == pictures_) return flip;
    }
    std::this_thread::sleep_for(kPause);
  }
  return std::nullopt;
}

bool KmsViewer::waitFor(hal::ScreenState state, rt::Nanoseconds patience) {
  const rt::Timestamp end = rt::now() + patience;
  while (rt::now() < end) {
    static_cast<void>(display_->tryPopFlip());
    if (display_->screen().state == state) return true;
    std::this_thread::sleep_for(kPause);
  }
  return false;
}

ScannedOut KmsViewer::drawn() {
  const hal::DisplayMode mode = display_->mode();
  ScannedOut picture{.width_px = mode.width_px, .height_px = mode.height_px, .rgba = {}};
  picture.rgba.resize(std::size_t{4} * mode.width_px * mode.height_px);
  EXPECT_TRUE(display_->readPicture(picture.rgba));
  return picture;
}

std::size_t KmsViewer::differs(ScanoutReader& reader) {
  return differingPixels(drawn(), reader.read());
}

}  // namespace test

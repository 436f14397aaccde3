#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "appliance/overlay/status_overlay.h"
#include "tests/golden/synthetic_scene.h"
#include "ui-kms/cpu_demosaic.h"
#include "ui-kms/offscreen_display.h"

const inline cv::Size kDisplay(1280, 720);

/// One camera picture with everything that is borrowed by a plan for it.
struct Camera {
  explicit Camera(cv::Size size, hal::PixelFormat format = hal::PixelFormat::kBayerRG8)
      : scene(syntheticScene(size)), mosaic(mosaicOf(scene, format)) {
    plan.source = {mosaic.data(), static_cast<std::uint32_t>(size.width),
                   static_cast<std::uint32_t>(size.height), format};
    plan.H_camera_display = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    plan.lens = {.fx_px = 1180,
                 .fy_px = 1175,
                 .cx_px = (size.width - 1) / 2.0,
                 .cy_px = (size.height - 1) / 2.0,
                 .max_radius = std::numeric_limits<double>::infinity()};
  }

  /// Zooms by @p scale (source pixels per display pixel) about both centres, turned by @p angle,
  /// with a tilt that makes w change by @p tilt over the display's width.
  void look(double scale, double angle, double tilt) {
    const double cosine = scale * std::cos(angle);
    const double sine = scale * std::sin(angle);
    const cv::Matx33d centre(1, 0, -(kDisplay.width - 1) / 2.0, 0, 1, -(kDisplay.height - 1) / 2.0,
                             0, 0, 1);
    const cv::Matx33d turn(cosine, -sine, 0, sine, cosine, 0, tilt / kDisplay.width,
                           tilt / 3 / kDisplay.width, 1);
    const cv::Matx33d back(1, 0, plan.lens.cx_px, 0, 1, plan.lens.cy_px, 0, 0, 1);
    const cv::Matx33d h = back * turn * centre;
    std::copy_n(h.val, 9, plan.H_camera_display.begin());
  }

  [[nodiscard]] cv::Mat3b demosaiced() const {
    cv::Mat4b rgba(scene.size());
    ui::demosaicOnCpu(plan.source, {reinterpret_cast<std::byte*>(rgba.data), rgba.total() * 4});
    cv::Mat3b rgb;
    cv::cvtColor(rgba, rgb, cv::COLOR_RGBA2RGB);
    return rgb;
  }

  cv::Mat3b scene;
  std::vector<std::byte> mosaic;
  hal::WarpPlan plan;
};

inline std::unique_ptr<ui::OffscreenDisplay> openDisplay(const ui::RendererConfig& renderer) {
  ui::OffscreenConfig config;
  config.renderer = renderer;
  config.refresh_hz = 1000;
  auto display = ui::OffscreenDisplay::create(config);
  EXPECT_TRUE(display) << display.error();
  return display ? std::move(*display) : nullptr;
}

inline std::unique_ptr<ui::OffscreenDisplay> makeDisplay(
    ui::DemosaicSite site = ui::DemosaicSite::kCpu, const std::string& font = {}) {
  ui::RendererConfig renderer;
  renderer.width_px = static_cast<std::uint32_t>(kDisplay.width);
  renderer.height_px = static_cast<std::uint32_t>(kDisplay.height);
  renderer.demosaic = site;
  renderer.font_path = font;
  return openDisplay(renderer);
}

/// For looking at: with KAGAMI_PICTURES set, each picture becomes a file in that folder.
inline void keepPicture(const std::string& name, const cv::Mat3f& rgb) {
  const char* folder = std::getenv("KAGAMI_PICTURES");
  if (folder == nullptr) return;
  cv::Mat3f bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  cv::imwrite(std::string(folder) + "/" + name + ".png", bgr);
}

/// Renders, commits and reads back, as RGB from 0 to 255.
inline cv::Mat3f shownScene(ui::OffscreenDisplay& display, const hal::Scene& scene) {
  const hal::DisplayMode mode = display.mode();
  cv::Mat4b rgba(static_cast<int>(mode.height_px), static_cast<int>(mode.width_px));
  EXPECT_TRUE(display.render(scene));
  // A vblank of 1 ms may have to pass since the last picture.
  const rt::Timestamp patience = rt::now() + std::chrono::seconds(20);
  while (!display.commit(1) && rt::now() < patience) std::this_thread::yield();
  EXPECT_TRUE(display.readPicture({reinterpret_cast<std::byte*>(rgba.data), rgba.total() * 4}));
  cv::Mat3b rgb;
  cv::cvtColor(rgba, rgb, cv::COLOR_RGBA2RGB);
  cv::Mat3f picture;
  rgb.convertTo(picture, CV_32FC3);
  return picture;
}

/// An overlay of this display, filled in by @p draw(typesetter, overlay).
template <class Draw>
std::unique_ptr<hal::Overlay> overlayOf(ui::OffscreenDisplay& display, Draw draw) {
  auto overlay = std::make_unique<hal::Overlay>();
  hal::Typesetter* const typesetter = display.typesetter();
  if (typesetter == nullptr) return overlay;
  typesetter->begin(*overlay);
  draw(*typesetter, *overlay);
  typesetter->finish(*overlay);
  EXPECT_EQ(overlay->refused, 0U);
  return overlay;
}

inline cv::Mat3f shown(ui::OffscreenDisplay& display, const hal::WarpPlan* plan,
                       const appliance::StatusText& status = {}) {
  hal::Scene scene;
  if (plan != nullptr) scene.layers[scene.count++].plan = *plan;
  const auto overlay = overlayOf(display, [&](hal::Typesetter& typesetter, hal::Overlay& filled) {
    const hal::DisplayMode mode = display.mode();
    addStatusLine(status, mode.width_px, mode.height_px, typesetter, filled);
  });
  scene.overlay = overlay.get();
  return shownScene(display, scene);
}

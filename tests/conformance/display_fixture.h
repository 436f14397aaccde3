#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hal/display.h"

namespace test {

struct DisplayBackend {
  std::string name;
  std::function<std::unique_ptr<hal::Display>()> make;
};

/// A display of one backend, and a picture and a line of text to draw.
class DisplayConformance : public testing::TestWithParam<DisplayBackend> {
 protected:
  void SetUp() override {
    display_ = GetParam().make();
    ASSERT_NE(display_, nullptr);
    write("live");
    pixels_.assign(std::size_t{64} * 48, std::byte{128});
    plan_.source = {pixels_.data(), 64, 48, hal::PixelFormat::kBayerRG8};
    plan_.H_camera_display = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    plan_.lens = {.fx_px = 50, .fy_px = 50, .cx_px = 31.5, .cy_px = 23.5, .max_radius = 10};
  }

  [[nodiscard]] hal::Scene scene() const {
    return {.layers = {hal::ViewLayer{.plan = plan_}}, .count = 1, .overlay = overlay_.get()};
  }
  /// The overlay's only line from now on.
  void write(const std::string& text) {
    hal::Typesetter* const typesetter = display_->typesetter();
    if (typesetter == nullptr) return;  // no font here
    typesetter->begin(*overlay_);
    typesetter->set(*overlay_, text,
                    {.x_px = 4, .baseline_px = 30, .width_px = 5'000, .size_px = 20}, {});
    typesetter->finish(*overlay_);
  }
  void renderOrFail() { ASSERT_TRUE(display_->render(scene())); }

  /// Commits as soon as the display is ready for it.
  rt::Timestamp commitWhenReady(std::uint64_t picture_id) {
    const rt::Timestamp patience = rt::now() + kPatience;
    while (rt::now() < patience) {
      if (const auto committed = display_->commit(picture_id)) return *committed;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "picture " << picture_id << " could not be committed";
    return {};
  }

  std::optional<hal::PageFlip> waitFlip() {
    const rt::Timestamp patience = rt::now() + kPatience;
    while (rt::now() < patience) {
      if (const auto flip = display_->tryPopFlip()) return flip;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::nullopt;
  }

  static constexpr std::chrono::seconds kPatience{20};
  std::unique_ptr<hal::Display> display_;
  std::vector<std::byte> pixels_;
  hal::WarpPlan plan_;
  std::unique_ptr<hal::Overlay> overlay_ = std::make_unique<hal::Overlay>();
};

}  // namespace test

#include <memory>

#include <gtest/gtest.h>

#include "tests/conformance/display_suite.h"
#include "ui-kms/offscreen_display.h"

namespace test {
namespace {

std::unique_ptr<hal::Display> makeOffscreen() {
  ui::OffscreenConfig config;
  config.renderer.width_px = 160;
  config.renderer.height_px = 90;
  config.refresh_hz = 100;
  auto display = ui::OffscreenDisplay::create(config);
  if (!display) {
    ADD_FAILURE() << display.error();
    return nullptr;
  }
  return std::move(*display);
}

INSTANTIATE_TEST_SUITE_P(Offscreen, DisplayConformance,
                         testing::Values(DisplayBackend{"offscreen", makeOffscreen}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace test

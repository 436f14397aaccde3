#include <cstdlib>

#include <gtest/gtest.h>

#include "ui-kms/offscreen_display.h"

// A binary of its own: what EGL finds is decided once per process.

namespace {

TEST(OffscreenDisplay, WithoutAnEglDriverSaysWhatToInstall) {
  ASSERT_EQ(::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/none.json", 1), 0);
  const auto display = ui::OffscreenDisplay::create({});
  ASSERT_FALSE(display);
  EXPECT_NE(display.error().find("no EGL"), std::string::npos) << display.error();
  EXPECT_NE(display.error().find("install"), std::string::npos) << display.error();
  EXPECT_EQ(display.error().find('\n'), std::string::npos) << display.error();
}

TEST(OffscreenDisplay, RefusesAScreenThatCannotBeAndNamesTheNumber) {
  ui::OffscreenConfig config;
  config.renderer.width_px = 0;
  EXPECT_NE(ui::OffscreenDisplay::create(config).error().find("0x720"), std::string::npos);
  config = {};
  config.refresh_hz = 0;
  EXPECT_NE(ui::OffscreenDisplay::create(config).error().find("refresh_hz"), std::string::npos);
  config = {};
  config.buffers = 1;
  EXPECT_NE(ui::OffscreenDisplay::create(config).error().find("buffers"), std::string::npos);
}

}  // namespace

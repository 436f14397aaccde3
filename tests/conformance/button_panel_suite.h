#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "hal/button_panel.h"

/// What every backend of hal::ButtonPanel must do. A test program includes this once and
/// instantiates ButtonPanelConformance with its backends.
namespace test {

using namespace std::chrono_literals;

/// A panel and what it needs to live.
struct OpenPanel {
  std::shared_ptr<void> hardware;  ///< may be none
  std::unique_ptr<hal::ButtonPanel> panel;
};

/// A panel whose freeze button goes down and up once, soon, and how a backend arranges that.
struct PanelBackend {
  const char* name;
  std::function<OpenPanel()> panelWithOnePressOfFreeze;
};

class ButtonPanelConformance : public testing::TestWithParam<PanelBackend> {
 protected:
  void SetUp() override { ASSERT_TRUE(open_.panel) << "the backend did not open"; }
  OpenPanel open_ = GetParam().panelWithOnePressOfFreeze();
  hal::ButtonPanel* panel_ = open_.panel.get();
};

TEST_P(ButtonPanelConformance, DeliversAPressAndItsReleaseInOrder) {
  const auto press = panel_->waitEvent(10s);
  ASSERT_TRUE(press);
  EXPECT_EQ(press->button, hal::Button::kFreeze);
  EXPECT_TRUE(press->pressed);
  EXPECT_TRUE(panel_->isPressed(hal::Button::kFreeze) || rt::now() > press->at + 50ms);
  const auto release = panel_->waitEvent(10s);
  ASSERT_TRUE(release);
  EXPECT_EQ(release->button, hal::Button::kFreeze);
  EXPECT_FALSE(release->pressed);
  EXPECT_GT(release->at, press->at);
  EXPECT_LE(release->at, rt::now());  // nothing from the future
  EXPECT_FALSE(panel_->isPressed(hal::Button::kFreeze));
}

TEST_P(ButtonPanelConformance, WaitsNoLongerThanAsked) {
  while (panel_->waitEvent(1s)) {
  }
  const rt::Timestamp before = rt::now();
  EXPECT_FALSE(panel_->waitEvent(20ms));
  EXPECT_GE(rt::now() - before, 20ms);
  EXPECT_FALSE(panel_->waitEvent(0ns));
  EXPECT_TRUE(panel_->alive());
}

TEST_P(ButtonPanelConformance, KnowsEveryButtonAndLamp) {
  for (std::size_t i = 0; i < hal::kButtons.size(); ++i) {
    const auto button = static_cast<hal::Button>(i);
    if (button != hal::Button::kFreeze) {
      EXPECT_FALSE(panel_->isPressed(button)) << hal::kButtons[i].name;
    }
  }
  for (const auto lamp : {hal::Lamp::kLive, hal::Lamp::kDelayed, hal::Lamp::kFrozen}) {
    panel_->setLamp(lamp, true);
    panel_->setLamp(lamp, false);
  }
  EXPECT_TRUE(panel_->alive());
}

}  // namespace test

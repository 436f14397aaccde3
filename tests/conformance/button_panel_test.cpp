#include <functional>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "hal/emulated/scripted_panel.h"

namespace {

using namespace std::chrono_literals;

/// A panel whose freeze button goes down and up, and how a backend arranges that.
struct Backend {
  const char* name;
  std::function<std::unique_ptr<hal::ButtonPanel>()> panelWithOnePressOfFreeze;
};

std::unique_ptr<hal::ButtonPanel> scripted() {
  return std::make_unique<hal::emulated::ScriptedPanel>(
      std::vector<hal::emulated::ScriptedChange>{{50ms, hal::Button::kFreeze, true},
                                                 {100ms, hal::Button::kFreeze, false}},
      rt::now());
}

class ButtonPanelConformance : public testing::TestWithParam<Backend> {
 protected:
  std::unique_ptr<hal::ButtonPanel> panel_ = GetParam().panelWithOnePressOfFreeze();
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
  for (std::size_t i = 0; i < hal::kButtonNames.size(); ++i) {
    const auto button = static_cast<hal::Button>(i);
    if (button != hal::Button::kFreeze) {
      EXPECT_FALSE(panel_->isPressed(button)) << hal::kButtonNames[i];
    }
  }
  for (const auto lamp : {hal::Lamp::kLive, hal::Lamp::kDelayed, hal::Lamp::kFrozen}) {
    panel_->setLamp(lamp, true);
    panel_->setLamp(lamp, false);
  }
  EXPECT_TRUE(panel_->alive());
}

INSTANTIATE_TEST_SUITE_P(Backends, ButtonPanelConformance,
                         testing::Values(Backend{"Scripted", scripted}),
                         [](const auto& backend) { return backend.param.name; });

}  // namespace

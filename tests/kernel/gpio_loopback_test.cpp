// The loop-back on a real GPIO chip: wired rightly, wrongly, and not at all.

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/capture/loopback.h"
#include "hal/gpiod/edge_input.h"
#include "hal/gpiod/trigger_line.h"
#include "tests/kernel/support/gpio_sim.h"
#include "tests/kernel/support/gpio_wire.h"

namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A trigger line and a loop-back input on one chip; what lies between is the test's.
class LoopbackOnAChip : public testing::Test {
 protected:
  void open(bool trigger_active_low = false, bool loopback_active_low = false) {
    auto opened =
        hal::gpiod::openTriggerLine({.lines = {"TRIGGER"}, .active_low = trigger_active_low});
    ASSERT_TRUE(opened) << opened.error();
    line = std::move(*opened);
    auto input_opened =
        hal::gpiod::openEdgeInput({.line = "BACK", .active_low = loopback_active_low});
    ASSERT_TRUE(input_opened) << input_opened.error();
    input = std::move(*input_opened);
  }
  std::string check() {
    const auto checked = appliance::checkLoopback(*line, *input);
    return checked ? "" : checked.error();
  }

  test::GpioSim chip{"board", {"SPARE", "TRIGGER", "BACK"}};
  std::unique_ptr<hal::TriggerLine> line;
  std::unique_ptr<hal::EdgeInput> input;
};

TEST_F(LoopbackOnAChip, IsContentWithAWireAndLeavesTheLineInactive) {
  const test::GpioWire wire("TRIGGER", test::pullOf(chip.lineFolder("BACK")));
  open();
  EXPECT_EQ(check(), "");
  EXPECT_FALSE(chip.level("TRIGGER"));
  EXPECT_FALSE(input->waitEdge(100ms)) << "the test's own edges must be taken away";
}

TEST_F(LoopbackOnAChip, IsContentWithAnInverterThatTheSettingsKnow) {
  const test::GpioWire wire("TRIGGER", test::pullOf(chip.lineFolder("BACK"), true));
  chip.pull("BACK", false);
  open(true, false);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(check(), "");
  EXPECT_TRUE(chip.level("TRIGGER")) << "inactive is high";
}

TEST_F(LoopbackOnAChip, FindsAnInverterThatTheSettingsDoNotKnow) {
  const test::GpioWire wire("TRIGGER", test::pullOf(chip.lineFolder("BACK"), true));
  chip.pull("BACK", true);
  open();
  std::this_thread::sleep_for(20ms);
  EXPECT_THAT(check(), HasSubstr("polarity wrong"));
  EXPECT_FALSE(chip.level("TRIGGER"));
}

TEST_F(LoopbackOnAChip, FindsAMissingWire) {
  open();
  EXPECT_THAT(check(), HasSubstr("no edge came back, the loop-back stays inactive"));
  chip.pull("BACK", true);
  EXPECT_THAT(check(), HasSubstr("no edge came back, the loop-back stays active"));
}

TEST_F(LoopbackOnAChip, StampsEveryEdgeOfATrainWithinItsOwnTime) {
  open();
  for (int i = 0; i < 100; ++i) {
    const bool up = i % 2 == 0;
    const rt::Timestamp before = rt::now();
    chip.pull("BACK", up);
    const rt::Timestamp after = rt::now();
    const auto edge = input->waitEdge(1s);
    ASSERT_TRUE(edge.has_value());
    EXPECT_EQ(edge->active, up);
    EXPECT_GE(edge->at, before);
    EXPECT_LE(edge->at, after + 1ms);
    EXPECT_EQ(input->isActive(), up);
  }
}

TEST_F(LoopbackOnAChip, TellsAnInputThatIsGone) {
  open();
  chip.remove();
  EXPECT_FALSE(input->waitEdge(20ms));
  EXPECT_FALSE(input->isActive().has_value());
  EXPECT_THAT(check(), HasSubstr("gone"));
}

TEST_F(LoopbackOnAChip, NamesALineThatIsNotThere) {
  const auto missing = hal::gpiod::openEdgeInput({.line = "BACKK"});
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error(), HasSubstr("trigger.loopback_line: no GPIO line is named"));
}

}  // namespace

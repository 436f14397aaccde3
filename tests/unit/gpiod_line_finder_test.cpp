#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/gpiod/expander.h"
#include "hal/gpiod/line_finder.h"
#include "hal/gpiod/trigger_line.h"
#include "tests/support/device_tree.h"

namespace {

using hal::gpiod::expanderBus;
using hal::gpiod::findLine;
using hal::gpiod::findOptionalLine;
using hal::gpiod::LineList;
using test::DeviceTree;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

LineList twoChips() {
  return {
      .lines = {{.name = "TRIGGER", .chip = "gpiochip0", .chip_label = "board", .offset = 4},
                {.name = "TRIGGER_BACK", .chip = "gpiochip0", .chip_label = "board", .offset = 5},
                {.name = "FAN",
                 .chip = "gpiochip0",
                 .chip_label = "board",
                 .offset = 6,
                 .consumer = "thermal"},
                {.name = "TWICE", .chip = "gpiochip0", .chip_label = "board", .offset = 7},
                {.name = "TWICE", .chip = "gpiochip1", .chip_label = "plug", .offset = 0}},
      .refused = {}};
}

TEST(LineFinder, FindsTheOneLineOfAName) {
  const auto line = findLine(twoChips(), "TRIGGER_BACK", "trigger.lines");
  ASSERT_TRUE(line.has_value()) << line.error();
  EXPECT_EQ(line->chip, "gpiochip0");
  EXPECT_EQ(line->offset, 5U);
}

TEST(LineFinder, NamesTheNearestLinesWhenOneIsMissing) {
  const auto line = findLine(twoChips(), "TRIGER", "trigger.lines");
  ASSERT_FALSE(line.has_value());
  EXPECT_THAT(line.error(),
              AllOf(StartsWith("trigger.lines: no GPIO line is named \"TRIGER\""),
                    HasSubstr("nearest names are \"TRIGGER\", "), Not(HasSubstr("\n"))));
}

TEST(LineFinder, SaysThatAMachineHasNoNamedLineAtAll) {
  EXPECT_THAT(findLine({}, "TRIGGER", "trigger.lines").error(),
              HasSubstr("this machine shows no named line: check the board's driver"));
}

TEST(LineFinder, NamesTheChipsThatItWasNotAllowedToLookAt) {
  LineList list = twoChips();
  list.refused = {"gpiochip2: Permission denied"};
  EXPECT_THAT(findLine(list, "LAMP", "panel").error(),
              AllOf(HasSubstr("gpiochip2: Permission denied"), HasSubstr("group gpio")));
  EXPECT_THAT(findLine({.lines = {}, .refused = list.refused}, "LAMP", "panel").error(),
              AllOf(HasSubstr("gpiochip2: Permission denied"), HasSubstr("group gpio")));
}

TEST(LineFinder, NamesBothChipsOfANameThatStandsTwice) {
  EXPECT_THAT(findLine(twoChips(), "TWICE", "trigger.lines").error(),
              AllOf(HasSubstr("gpiochip0 (board)"), HasSubstr("gpiochip1 (plug)")));
}

TEST(LineFinder, NamesWhoHoldsABusyLine) {
  EXPECT_THAT(findLine(twoChips(), "FAN", "trigger.lines").error(),
              HasSubstr("held by \"thermal\""));
  EXPECT_FALSE(findOptionalLine(twoChips(), "FAN", "panel").has_value());
}

TEST(LineFinder, AnOptionalLineMayBeMissing) {
  const auto line = findOptionalLine(twoChips(), "LAMP", "panel");
  ASSERT_TRUE(line.has_value());
  EXPECT_FALSE(line->has_value());
}

TEST(Expander, AChipOfTheBoardHangsOnNoBus) {
  const DeviceTree tree;
  tree.add("platform/INTC1056:00", "platform");
  tree.addChip("platform/INTC1056:00", "gpiochip0");
  tree.add("pci0000:00", "pci");
  tree.add("pci0000:00/0000:00:1f.0", "pci");
  tree.addChip("pci0000:00/0000:00:1f.0", "gpiochip1");
  EXPECT_EQ(expanderBus(tree.root(), "gpiochip0"), std::nullopt);
  EXPECT_EQ(expanderBus(tree.root(), "gpiochip1"), std::nullopt);
}

TEST(Expander, IsToldByTheBusThatItsDeviceIsOn) {
  const DeviceTree tree;
  tree.add("pci0000:00/0000:00:15.0", "pci");
  tree.add("pci0000:00/0000:00:15.0/i2c-1", "i2c");
  tree.add("pci0000:00/0000:00:15.0/i2c-1/1-0020", "i2c");
  tree.addChip("pci0000:00/0000:00:15.0/i2c-1/1-0020", "gpiochip0");
  tree.add("platform/spi0/spi0.0", "spi");
  tree.addChip("platform/spi0/spi0.0", "gpiochip1");
  tree.add("pci0000:00/usb1/1-2/1-2:1.0", "usb");
  tree.addChip("pci0000:00/usb1/1-2/1-2:1.0", "gpiochip2");
  EXPECT_EQ(expanderBus(tree.root(), "gpiochip0"), "i2c");
  EXPECT_EQ(expanderBus(tree.root(), "gpiochip1"), "spi");
  EXPECT_EQ(expanderBus(tree.root(), "gpiochip2"), "usb");
}

TEST(Expander, IsFoundBehindADeviceOfSeveralFunctions) {
  const DeviceTree tree;
  tree.add("platform/i2c0/0-0048", "i2c");
  tree.add("platform/i2c0/0-0048/pmic-gpio", "platform");
  tree.addChip("platform/i2c0/0-0048/pmic-gpio", "gpiochip0");
  EXPECT_EQ(expanderBus(tree.root(), "gpiochip0"), "i2c");
}

TEST(Expander, AChipOrATreeThatIsNotThereHangsOnNothing) {
  const DeviceTree tree;
  EXPECT_EQ(expanderBus(tree.root(), "gpiochip7"), std::nullopt);
  EXPECT_EQ(expanderBus("/nonexistent", "gpiochip0"), std::nullopt);
}

TEST(GpioTriggerLine, WantsLinesToBeNamed) {
  const auto line = hal::gpiod::openTriggerLine({});
  ASSERT_FALSE(line.has_value());
  EXPECT_THAT(line.error(), HasSubstr("trigger.lines is empty"));
}

}  // namespace

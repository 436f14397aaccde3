// What every other test of this tier needs.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/kernel/support/files.h"
#include "tests/kernel/support/gpio_sim.h"
#include "tests/kernel/support/gpio_trace.h"
#include "tests/kernel/support/vkms.h"

namespace {

namespace fs = std::filesystem;

TEST(KernelBed, HasAScreen) {
  EXPECT_TRUE(fs::exists("/dev/dri/card0"));
  // "unknown" until a program looks.
  EXPECT_NE(test::readAttribute("/sys/class/drm/card0-Virtual-1/status"), "disconnected");
}

TEST(KernelBed, MakesGpioChipsWithNamedLines) {
  test::GpioSim chip("smoke", {"BUTTON", "", "LAMP"});
  EXPECT_TRUE(fs::exists(chip.path()));
  EXPECT_FALSE(chip.level("BUTTON"));
  chip.pull("BUTTON", true);
  EXPECT_TRUE(chip.level("BUTTON"));
  EXPECT_THROW(chip.pull("SOMETHING", true), std::runtime_error);
  chip.remove();
  EXPECT_FALSE(fs::exists(chip.path()));
}

TEST(KernelBed, FindsTheNumberOfALineThatWasNeverDriven) {
  test::GpioSim first("smoke", {"ZERO", "ONE"});
  test::GpioSim second("smoke2", {"TWO", "THREE"});
  EXPECT_EQ(test::GpioTrace::numberOf("ONE"), test::GpioTrace::numberOf("ZERO") + 1);
  EXPECT_EQ(test::GpioTrace::numberOf("TWO"), test::GpioTrace::numberOf("ZERO") + 2);
  EXPECT_THROW((void)test::GpioTrace::numberOf("FOUR"), std::runtime_error);
}

TEST(KernelBed, MakesCardsWhoseScreenCanBeUnplugged) {
  if (!test::Vkms::available()) GTEST_SKIP() << "this kernel has no configfs for VKMS (7.2 has)";
  test::Vkms card("smoke", false);
  EXPECT_TRUE(fs::exists(card.card()));
  std::string status;
  for (const auto& entry : fs::directory_iterator("/sys/devices/faux/smoke/drm/" +
                                                  fs::path(card.card()).filename().string())) {
    if (entry.path().string().find("-Virtual-") != std::string::npos) {
      status = entry.path() / "status";
    }
  }
  ASSERT_FALSE(status.empty());
  EXPECT_EQ(test::readAttribute(status), "disconnected");
  card.setConnected(true);
  EXPECT_EQ(test::readAttribute(status), "connected");
}

TEST(KernelBed, ThrowsAwayWhatATestWrites) {
  std::ofstream("/etc/written-in-the-bed") << "gone with it";
  EXPECT_TRUE(fs::exists("/etc/written-in-the-bed"));
}

}  // namespace

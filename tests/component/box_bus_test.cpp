// A part on the bus: its object, its line in the status, its long work.

#include <array>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/box/box.h"
#include "tests/support/becomes_true.h"
#include "tests/support/no_display.h"
#include "tests/support/output_of.h"
#include "tests/support/private_bus.h"
#include "tests/support/served_box.h"
#include "tests/support/small_site.h"
#include "tests/unit/sample_part/sample_part.h"

namespace {

using appliance::Box;
using testing::HasSubstr;

appliance::MadePart makeSample(const appliance::Shared& shared) {
  return appliance::makeSamplePart(shared, {});
}

class BoxOnTheBus : public testing::Test {
 protected:
  void SetUp() override {
    if (bus_.address().empty())
      GTEST_SKIP() << "dbus-daemon cannot be started here (package dbus-daemon)";
    if (test::outputOf("busctl --version").find("systemd") == std::string::npos)
      GTEST_SKIP() << "busctl is not installed (package systemd)";
    static constexpr std::array<appliance::PartEntry, 1> kParts = {{{makeSample}}};
    auto box = Box::start(test::smallSite(), {.display = display_, .parts = kParts});
    ASSERT_TRUE(box.has_value()) << box.error();
    box_ = std::move(*box);
    served_ = std::make_unique<test::ServedBox>(*box_, bus_.address());
    ASSERT_TRUE(test::becomesTrue([&] { return turns().starts_with("x "); }));
  }
  void TearDown() override {
    served_.reset();
    if (!box_) return;
    EXPECT_TRUE(box_->stop().has_value());
  }

  /// What busctl prints for @p words.
  [[nodiscard]] std::string busctl(const std::string& words) const {
    return test::outputOf("busctl --address='" + bus_.address() + "' " + words);
  }
  [[nodiscard]] std::string turns() const { return busctl("get-property" + kSample + "Turns"); }

  const std::string kSample =
      " org.kagami.Kagami1 /org/kagami/Kagami1/sample org.kagami.Kagami1.Sample ";
  const std::string kJob = " org.kagami.Kagami1 /org/kagami/Kagami1/jobs/1 org.kagami.Kagami1.Job ";

  test::PrivateBus bus_;
  test::NoDisplay display_;
  std::unique_ptr<Box> box_;
  std::unique_ptr<test::ServedBox> served_;
};

TEST_F(BoxOnTheBus, ShowsAPartsOwnObjectAndItsLineInTheStatus) {
  EXPECT_EQ(busctl("call" + kSample + "Reset"), "");
  EXPECT_THAT(busctl("call org.kagami.Kagami1 /org/kagami/Kagami1 org.kagami.Kagami1 Status"),
              HasSubstr("counting"));
}

TEST_F(BoxOnTheBus, ShowsThatAPartsJobIsDoneAndWhatItCameTo) {
  EXPECT_EQ(busctl("call" + kSample + "Count u 5"), "o \"/org/kagami/Kagami1/jobs/1\"\n");
  EXPECT_TRUE(
      test::becomesTrue([&] { return busctl("get-property" + kJob + "State") == "s \"done\"\n"; }));
  EXPECT_EQ(busctl("get-property" + kJob + "Kind"), "s \"sample-count\"\n");
  EXPECT_EQ(busctl("get-property" + kJob + "Progress"), "d 1\n");
  EXPECT_EQ(busctl("get-property" + kJob + "Result"), "s \"5 turns\"\n");
}

TEST_F(BoxOnTheBus, CancelsAPartsJob) {
  EXPECT_EQ(busctl("call" + kSample + "Count u 4000000000"), "o \"/org/kagami/Kagami1/jobs/1\"\n");
  EXPECT_EQ(busctl("get-property" + kJob + "State"), "s \"running\"\n");
  EXPECT_EQ(busctl("call" + kJob + "Cancel"), "");
  EXPECT_TRUE(test::becomesTrue(
      [&] { return busctl("get-property" + kJob + "State") == "s \"cancelled\"\n"; }));
}

TEST_F(BoxOnTheBus, EndsWithAPartsJobStillRunning) {
  EXPECT_EQ(busctl("call" + kSample + "Count u 4000000000"), "o \"/org/kagami/Kagami1/jobs/1\"\n");
}

}  // namespace

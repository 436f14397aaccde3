// What goes wrong while a box starts or runs: one line for a person, and nothing is left running.

#include <array>
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/box/box.h"
#include "rt/clock.h"
#include "tests/support/becomes_true.h"
#include "tests/support/no_display.h"
#include "tests/support/small_site.h"
#include "tests/unit/sample_part/sample_part.h"

namespace {

using namespace std::chrono_literals;
using appliance::Box;
using appliance::MadePart;
using appliance::Part;
using appliance::PartEntry;
using appliance::SampleSettings;
using appliance::Shared;
using appliance::Site;
using appliance::Status;
using test::NoDisplay;
using test::smallSite;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

MadePart makeSample(const Shared& shared) {
  return appliance::makeSamplePart(shared, SampleSettings{});
}

/// Can be made, but not started.
class BrokenPart final : public Part {
 public:
  [[nodiscard]] std::string_view name() const override { return "broken"; }
  [[nodiscard]] std::expected<void, std::string> start() override {
    return std::unexpected("the lamp is broken: replace it");
  }
  void stop() override {}
  void report(Status& /*status*/) const override {}
};

MadePart makeBroken(const Shared& /*shared*/) {
  return std::make_unique<BrokenPart>();
}

/// Starts, and its stop() waits for the test.
class StuckPart final : public Part {
 public:
  explicit StuckPart(std::shared_future<void> released) : released_(std::move(released)) {}
  [[nodiscard]] std::string_view name() const override { return "stuck"; }
  [[nodiscard]] std::expected<void, std::string> start() override { return {}; }
  void stop() override { released_.wait(); }
  void report(Status& /*status*/) const override {}

 private:
  const std::shared_future<void> released_;
};

std::promise<void>& hold() {
  static std::promise<void> promise;
  return promise;
}

MadePart makeStuck(const Shared& /*shared*/) {
  return std::make_unique<StuckPart>(hold().get_future().share());
}

/// Threads of this process.
std::ptrdiff_t threads() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

TEST(BoxFailures, APartThatDoesNotStartEndsTheEarlierOnesAndSaysWhyInOneLine) {
  NoDisplay display;
  const std::ptrdiff_t before = threads();
  const std::array<PartEntry, 3> parts = {{{makeSample}, {makeBroken}, {makeSample}}};
  const auto box = Box::start(smallSite(), {.display = display, .parts = parts});
  ASSERT_FALSE(box.has_value());
  EXPECT_EQ(box.error(), "the lamp is broken: replace it");
  EXPECT_EQ(threads(), before) << "the thread of the first part is left";
}

TEST(BoxFailures, APartThatHangsAfterAFailedStartDoesNotKeepTheProcess) {
  NoDisplay display;
  const std::array<PartEntry, 3> parts = {{{makeSample}, {makeStuck}, {makeBroken}}};
  std::vector<std::string> said;
  const auto box = Box::start(
      smallSite(), {.display = display,
                    .parts = parts,
                    .patience = 50ms,
                    .on_hang = [&](const std::vector<std::string>& lines) { said = lines; }});
  ASSERT_FALSE(box.has_value());
  EXPECT_THAT(said, ElementsAre(testing::AllOf(HasSubstr("the lamp is broken: replace it"),
                                               HasSubstr("part stuck does not stop"))));
  hold().set_value();
}

TEST(BoxFailures, SaysThatItsTraceIsNotWrittenAnyMoreAndGoesOn) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  NoDisplay display;
  Site site = smallSite();
  site.config.state.trace = "/dev/full";
  const std::array<PartEntry, 1> parts = {{{makeSample}}};
  auto box = Box::start(site, {.display = display, .parts = parts});
  ASSERT_TRUE(box.has_value()) << box.error();
  const auto remarks = [&] { return (*box)->status().degraded; };
  const auto trace = Contains(
      testing::AllOf(Field(&appliance::Remark::key, "trace"),
                     Field(&appliance::Remark::word, appliance::Word::kTraceFailed),
                     Field(&appliance::Remark::text, HasSubstr("No space left on device"))));
  EXPECT_TRUE(test::becomesTrue([&] { return testing::Value(remarks(), trace); }));
  const auto stopped = (*box)->stop();
  ASSERT_FALSE(stopped.has_value());
  EXPECT_THAT(stopped.error(), HasSubstr("cannot write the trace"));
}

}  // namespace

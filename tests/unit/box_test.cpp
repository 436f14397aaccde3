#include "appliance/box/box.h"

#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/config/section.h"
#include "appliance/trace/trace_file.h"
#include "rt/periodic_loop.h"
#include "tests/support/no_display.h"
#include "tests/support/small_site.h"
#include "tests/support/temporary_folder.h"
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
MadePart makeNone(const Shared& /*shared*/) {
  return nullptr;
}
MadePart makeBroken(const Shared& /*shared*/) {
  return std::unexpected("broken.line is no line of this machine");
}

TEST(Box, RunsAPartThatItKnowsByOneEntryOnly) {
  NoDisplay display;
  const std::array<PartEntry, 2> parts = {{{makeNone}, {makeSample}}};
  auto box = Box::start(smallSite(), {.display = display, .parts = parts});
  ASSERT_TRUE(box.has_value()) << box.error();
  const rt::Timestamp patience = rt::now() + 20s;
  const auto turns = [&] {
    const Status status = (*box)->status();
    for (const auto& section : status.sections)
      if (section.key == "sample") return std::get<std::int64_t>(section.values.at(0).value);
    return std::int64_t{-1};
  };
  while (turns() < 2 && rt::now() < patience) rt::sleepUntil(rt::now() + 1ms);
  EXPECT_GE(turns(), 2);
  EXPECT_TRUE((*box)->stop().has_value());
  const std::int64_t at_end = turns();
  rt::sleepUntil(rt::now() + 5ms);
  EXPECT_EQ(turns(), at_end) << "its thread has ended";
}

TEST(Box, ReadsThePartsOwnSectionRefusesAWrongValueAndWarnsOfAnUnknownKey) {
  const auto read = [](const char* text) {
    const auto file = appliance::TomlFile::parse(text, "kagamid.toml");
    appliance::ConfigReading reading;
    appliance::Section root(file->root(), "", reading);
    SampleSettings settings;
    appliance::read(root.sub("sample"), settings);
    EXPECT_THAT(reading.keys, ElementsAre("sample.enabled", "sample.period_ms"));
    return std::tuple{settings, file->fault(), file->warnings()};
  };
  EXPECT_EQ(std::get<0>(read("[sample]\nperiod_ms = 20")).period, 20ms);
  EXPECT_THAT(std::get<1>(read("[sample]\nperiod_ms = 0")).value_or(""), HasSubstr("period_ms"));
  EXPECT_THAT(std::get<2>(read("[sample]\nperio_ms = 5")), ElementsAre(HasSubstr("period_ms")));
}

TEST(Box, DoesNotStartIfAPartCannotBeMadeAndSaysWhyInOneLine) {
  NoDisplay display;
  const std::array<PartEntry, 2> parts = {{{makeSample}, {makeBroken}}};
  const auto box = Box::start(smallSite(), {.display = display, .parts = parts});
  ASSERT_FALSE(box.has_value());
  EXPECT_EQ(box.error(), "broken.line is no line of this machine");
}

TEST(Box, SaysWhatTheSiteAlreadyKnewToBeLessThanConfigured) {
  NoDisplay display;
  Site site = smallSite();
  site.degraded = {appliance::phrase<appliance::Word::kConfigNote>("30.0 Hz instead of 40")};
  auto box = Box::start(site, {.display = display, .parts = {}});
  ASSERT_TRUE(box.has_value()) << box.error();
  EXPECT_THAT((*box)->status().degraded,
              Contains(Field(&appliance::Remark::text, HasSubstr("30.0 Hz instead of 40"))));
}

TEST(Box, CountsCommandsThatTooManyOthersWaitBefore) {
  NoDisplay display;
  auto box = Box::start(smallSite(), {.display = display, .parts = {}});
  ASSERT_TRUE(box.has_value()) << box.error();
  const appliance::Command freeze{appliance::Command::Kind::kFreezeToggle};
  for (std::uint32_t i = 0; i < appliance::kMostCommands; ++i) ASSERT_TRUE((*box)->command(freeze));
  EXPECT_FALSE((*box)->command(freeze));
  EXPECT_THAT(
      (*box)->status().sections,
      Contains(appliance::StatusSection{
          .key = "commands", .line = "", .values = {{"control_refused", std::int64_t{1}}}}));
}

std::promise<void>& hold() {
  static std::promise<void> promise;
  return promise;
}

/// Its thread sits in a driver that does not come back.
class StuckPart final : public Part {
 public:
  [[nodiscard]] std::string_view name() const override { return "stuck"; }
  [[nodiscard]] std::expected<void, std::string> start() override { return {}; }
  void stop() override { released_.wait(); }
  void report(Status& /*status*/) const override {}

 private:
  const std::shared_future<void> released_ = hold().get_future().share();
};

MadePart makeStuck(const Shared& /*shared*/) {
  return std::make_unique<StuckPart>();
}

TEST(Box, EndsWithoutAPartThatHangsOnceTheOthersHaveStoppedAndTheTraceIsWhole) {
  const test::TemporaryFolder folder;
  NoDisplay display;
  Site site = smallSite();
  site.config.state.trace = folder / "trace.jsonl";
  const std::array<PartEntry, 2> parts = {{{makeSample}, {makeStuck}}};
  std::vector<std::string> said;
  bool trace_was_whole = false;
  auto box = Box::start(site, {.display = display,
                               .parts = parts,
                               .patience = 50ms,
                               .on_hang = [&](const std::vector<std::string>& lines) {
                                 said = lines;
                                 const auto trace =
                                     appliance::readTraceFile(folder / "trace.jsonl");
                                 trace_was_whole = trace && trace->summary.has_value();
                               }});
  ASSERT_TRUE(box.has_value()) << box.error();
  const auto stopped = (*box)->stop();
  ASSERT_FALSE(stopped.has_value());
  EXPECT_THAT(stopped.error(), HasSubstr("part stuck does not stop"));
  EXPECT_THAT(said, ElementsAre(HasSubstr("part stuck does not stop")));
  EXPECT_TRUE(trace_was_whole);
  hold().set_value();
}

}  // namespace

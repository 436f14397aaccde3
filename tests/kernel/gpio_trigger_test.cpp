// The trigger line on a real GPIO chip: what leaves on the wire, to the nanosecond of virtual time.

#include <atomic>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/capture/trigger_loop.h"
#include "hal/gpiod/trigger_line.h"
#include "rt/thread.h"
#include "tests/conformance/trigger_line_suite.h"
#include "tests/kernel/support/gpio_sim.h"
#include "tests/kernel/support/gpio_trace.h"
#include "tests/support/child_process.h"
#include "tests/support/device_tree.h"
#include "tests/support/temporary_folder.h"

// Counts what the C++ library and libgpiod allocate: the trigger loop must never do so.
namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace
extern "C" void* __libc_malloc(std::size_t);               // NOLINT(bugprone-reserved-identifier)
extern "C" void* __libc_calloc(std::size_t, std::size_t);  // NOLINT(bugprone-reserved-identifier)
extern "C" void* malloc(std::size_t bytes) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(bytes);
}
extern "C" void* calloc(std::size_t count, std::size_t bytes) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_calloc(count, bytes);
}

namespace test {
namespace {

using namespace std::chrono_literals;
using hal::gpiod::openTriggerLine;
using testing::AllOf;
using testing::HasSubstr;

/// Watches one line of a chip of our own; active is what the cameras see.
class SimObserver final : public LineObserver {
 public:
  explicit SimObserver(bool active_low) : active_low_(active_low) {}

  std::optional<bool> waitLevel() override {
    for (int look = 0; edges_.empty() && look < 500; ++look) {
      const auto edges = outputEdges(trace_.take(), number_, level_);
      edges_.insert(edges_.end(), edges.begin(), edges.end());
      if (!edges.empty()) level_ = edges.back().level;
      if (edges_.empty()) std::this_thread::sleep_for(10ms);
    }
    if (edges_.empty()) return std::nullopt;
    last_ = edges_.front();
    edges_.pop_front();
    return last_.level != active_low_;
  }
  [[nodiscard]] std::optional<rt::Timestamp> edgeStamp() const override {
    return rt::fromNs(last_.time_ns);
  }

 private:
  bool active_low_;
  GpioSim chip_{"board", {"SPARE", "TRIGGER"}};
  std::uint32_t number_ = GpioTrace::numberOf("TRIGGER");
  GpioTrace trace_{"observer"};
  bool level_ = active_low_;  // inactive
  std::deque<GpioEvent> edges_;
  GpioEvent last_;
};

ObservedLine gpiod(bool active_low) {
  auto observer = std::make_unique<SimObserver>(active_low);
  auto line = openTriggerLine({.lines = {"TRIGGER"}, .active_low = active_low});
  if (!line) {
    ADD_FAILURE() << line.error();
    return {};
  }
  return {std::move(observer), std::move(*line)};
}

INSTANTIATE_TEST_SUITE_P(Backends, TriggerLineConformance,
                         testing::Values(LineBackend{"Gpiod", [] { return gpiod(false); }},
                                         LineBackend{"GpiodActiveLow", [] { return gpiod(true); }}),
                         [](const auto& backend) { return backend.param.name; });

std::string faultOf(const std::vector<std::string>& lines) {
  const auto line = openTriggerLine({.lines = lines});
  return line ? "no fault" : line.error();
}

TEST(GpioTriggerLine, IsInactiveFromTheFirstMoment) {
  for (const bool active_low : {false, true}) {
    GpioSim chip("board", {"SPARE", "TRIGGER"});
    chip.pull("TRIGGER", !active_low);  // the wire is active while it is not driven
    const std::uint32_t number = GpioTrace::numberOf("TRIGGER");
    GpioTrace trace("opening");
    const auto line = openTriggerLine({.lines = {"TRIGGER"}, .active_low = active_low});
    ASSERT_TRUE(line) << line.error();
    EXPECT_EQ(chip.level("TRIGGER"), active_low);
    for (const GpioEvent& event : trace.take())
      if (event.number == number && event.written) {
        EXPECT_EQ(event.level, active_low);
      }
  }
}

TEST(GpioTriggerLine, DrivesAllItsLinesTogetherAndNoOther) {
  GpioSim chip("board", {"SPARE", "LEFT", "OTHER", "RIGHT"});
  const std::uint32_t left = GpioTrace::numberOf("LEFT");
  GpioTrace trace("together");
  const auto line = openTriggerLine({.lines = {"RIGHT", "LEFT"}});
  ASSERT_TRUE(line) << line.error();
  for (const bool active : {true, false, true}) {
    ASSERT_TRUE((*line)->setActive(active));
    EXPECT_EQ(chip.level("LEFT"), active);
    EXPECT_EQ(chip.level("RIGHT"), active);
    EXPECT_FALSE(chip.level("OTHER"));
    std::this_thread::sleep_for(1ms);
  }
  const auto events = trace.take();
  const auto of_left = outputEdges(events, left, false);
  const auto of_right = outputEdges(events, left + 2, false);
  ASSERT_EQ(of_left.size(), 3U);
  ASSERT_EQ(of_right.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    // Only the recorder's reading of the clock lies between them.
    EXPECT_LE(std::abs(of_left[i].time_ns - of_right[i].time_ns), 1000);
  }
  EXPECT_TRUE(outputEdges(events, left + 1, false).empty());
}

TEST(GpioTriggerLine, AllocatesNothingWhileItFires) {
  GpioSim chip("board", {"LEFT", "RIGHT"});
  const auto line = openTriggerLine({.lines = {"LEFT", "RIGHT"}});
  ASSERT_TRUE(line) << line.error();
  ASSERT_GT(allocations.load(), 0U) << "the counter does not count";
  const std::size_t before = allocations.load();
  bool all = true;
  for (int i = 0; i < 1000; ++i) all = (*line)->setActive(i % 2 == 0).has_value() && all;
  EXPECT_EQ(allocations.load(), before);
  EXPECT_TRUE(all);
}

TEST(GpioTriggerLine, TellsAChipThatIsGone) {
  GpioSim chip("board", {"TRIGGER"});
  const auto line = openTriggerLine({.lines = {"TRIGGER"}});
  ASSERT_TRUE(line) << line.error();
  chip.remove();
  const auto edge = (*line)->setActive(true);
  ASSERT_FALSE(edge);
  EXPECT_EQ(edge.error().code, rt::Errc::kDeviceLost);
}

TEST(GpioTriggerLine, RefusesALineBehindAnExpanderAndClaimsNothing) {
  const GpioSim chip("board", {"TRIGGER"});
  const DeviceTree tree;
  tree.add("i2c-1/1-0020", "i2c");
  tree.addChip("i2c-1/1-0020", std::filesystem::path(chip.path()).filename());
  const auto line = openTriggerLine({.lines = {"TRIGGER"}}, tree.root());
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error(), HasSubstr("is behind an expander on the bus i2c"));
  EXPECT_EQ(faultOf({"TRIGGER"}), "no fault");
}

TEST(GpioTriggerLine, SaysInOneLineWhatIsWrongWithItsNames) {
  GpioSim board("board", {"TRIGGER", "LEFT", "RIGHT"});
  GpioSim plug("plug", {"FAR", "RIGHT"});
  EXPECT_THAT(faultOf({"TRIGER"}),
              AllOf(HasSubstr("no GPIO line is named \"TRIGER\""), HasSubstr("\"TRIGGER\"")));
  EXPECT_THAT(faultOf({"LEFT", "FAR"}), HasSubstr("lines that fire together must be on one chip"));
  EXPECT_THAT(faultOf({"RIGHT"}), HasSubstr("two GPIO lines are named \"RIGHT\""));
  const auto holder = openTriggerLine({.lines = {"LEFT"}});
  ASSERT_TRUE(holder) << holder.error();
  EXPECT_THAT(faultOf({"LEFT"}), HasSubstr("held by \"kagamid\""));
  EXPECT_THAT(faultOf({"TRIGGER", "TRIGGER"}), HasSubstr("\"TRIGGER\" stands twice"));
}

TEST(TriggerLoop, PulsesOnTheRightLineWithPeriodAndWidthExact) {
  GpioSim chip("board", {"SPARE", "TRIGGER"});
  const std::uint32_t number = GpioTrace::numberOf("TRIGGER");
  GpioTrace trace("pulses");
  auto line = openTriggerLine({.lines = {"TRIGGER"}});
  ASSERT_TRUE(line) << line.error();
  appliance::EdgeBoard edges;
  appliance::GenlockBoard genlock;
  constexpr rt::Nanoseconds kPeriod = 25ms;
  constexpr rt::Nanoseconds kWidth = 100us;
  appliance::TriggerLoop loop({.period = kPeriod, .pulse_width = kWidth}, **line, edges, genlock,
                              nullptr);
  {
    auto thread =
        rt::Thread::start({.name = "trigger", .policy = rt::SchedPolicy::kFifo, .priority = 80},
                          [&](const std::stop_token& stop) { loop.run(stop); });
    ASSERT_TRUE(thread.has_value());
    std::this_thread::sleep_for(60s);
  }
  EXPECT_EQ(loop.metrics().missed.value(), 0U);
  EXPECT_EQ(loop.metrics().failed.value(), 0U);
  const auto events = outputEdges(trace.take(), number, false);
  ASSERT_GE(events.size(), 2U * 2390);
  ASSERT_EQ(events.size() % 2, 0U) << "the line was left active";
  std::int64_t worst_period_ns = 0;
  std::int64_t worst_width_ns = 0;
  for (std::size_t i = 0; i < events.size(); i += 2) {
    ASSERT_TRUE(events[i].level && !events[i + 1].level) << "a pulse is cut or doubled";
    const auto pulse = static_cast<std::int64_t>(i / 2);
    const std::int64_t grid_ns = events[0].time_ns + pulse * kPeriod.count();
    worst_period_ns = std::max(worst_period_ns, std::abs(events[i].time_ns - grid_ns));
    const std::int64_t width_ns = events[i + 1].time_ns - events[i].time_ns;
    worst_width_ns = std::max(worst_width_ns, std::abs(width_ns - kWidth.count()));
    const rt::Timestamp posted = edges.edge(static_cast<std::uint64_t>(pulse) + 1);
    if (posted != rt::Timestamp{}) {
      EXPECT_LE(std::abs(events[i].time_ns - rt::toNs(posted)), 1000);
    }
  }
  std::printf("%zu pulses: off the grid by at most %ld ns, off the width by at most %ld ns\n",
              events.size() / 2, worst_period_ns, worst_width_ns);
  // In virtual time only the readings of the clock themselves take time.
  EXPECT_LE(worst_period_ns, 1000);
  EXPECT_LE(worst_width_ns, 1000);
}

TEST(ReleaseLines, DrivesTheConfiguredLinesInactive) {
  for (const bool active_low : {false, true}) {
    GpioSim chip("board", {"SPARE", "LEFT", "RIGHT"});
    const std::uint32_t left = GpioTrace::numberOf("LEFT");
    GpioTrace trace("releasing");
    const TemporaryFolder folder;
    ChildProcess release(
        {KAGAMID, "--config", KAGAMID_CONFIG, "--set", "trigger.backend=gpiod", "--set",
         R"(trigger.lines=["LEFT","RIGHT"])", "--set",
         std::string("trigger.active_low=") + (active_low ? "true" : "false"), "--release-lines"},
        folder / "log");
    EXPECT_EQ(release.wait(30s), 0) << release.output();
    const auto events = trace.take();
    for (const std::uint32_t number : {left, left + 1}) {
      const auto edges = outputEdges(events, number);
      ASSERT_EQ(edges.size(), 1U);
      EXPECT_EQ(edges[0].level, active_low);
    }
  }
}

TEST(ReleaseLines, SaysWhyItCannot) {
  GpioSim chip("board", {"LEFT"});
  const TemporaryFolder folder;
  ChildProcess release({KAGAMID, "--config", KAGAMID_CONFIG, "--set", "trigger.backend=gpiod",
                        "--set", R"(trigger.lines=["RIGHT"])", "--release-lines"},
                       folder / "log");
  EXPECT_EQ(release.wait(30s), EXIT_FAILURE);
  EXPECT_THAT(release.output(), HasSubstr("no GPIO line is named \"RIGHT\""));
}

}  // namespace
}  // namespace test

#include <atomic>
#include <deque>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/capture/loopback.h"
#include "appliance/trace/trace_file.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace appliance;
using namespace std::chrono_literals;
using testing::HasSubstr;

std::string faultOf(const LoopbackReading& reading) {
  const auto judged = judgeLoopback(reading);
  return judged ? "" : judged.error();
}

TEST(Loopback, IsContentWhenThePulseComesBack) {
  EXPECT_EQ(faultOf({.before = false, .during = true, .after = false, .edge = true}), "");
}

TEST(Loopback, TellsWrongPolarityFromAMissingWire) {
  for (const bool edge : {false, true}) {
    EXPECT_THAT(faultOf({.before = true, .during = false, .after = true, .edge = edge}),
                HasSubstr("polarity wrong"));
    EXPECT_THAT(faultOf({.before = false, .during = false, .after = false, .edge = edge}),
                HasSubstr("no edge came back, the loop-back stays inactive"));
    EXPECT_THAT(faultOf({.before = true, .during = true, .after = true, .edge = edge}),
                HasSubstr("no edge came back, the loop-back stays active"));
    EXPECT_THAT(faultOf({.before = false, .during = true, .after = true, .edge = edge}),
                HasSubstr("changed once and stayed so"));
  }
  EXPECT_THAT(faultOf({.before = false, .during = true, .after = false, .edge = false}),
              HasSubstr("stamps no edges"));
}

/// A trigger line and the input that its wire leads to.
class Wire final : public hal::TriggerLine, public hal::EdgeInput {
 public:
  rt::Result<hal::TriggerEdge> setActive(bool active) noexcept override {
    if (gone) return std::unexpected(rt::Error{rt::Errc::kDeviceLost});
    const rt::Timestamp at = rt::now();
    if (active != active_) edges.push_back({.active = active != inverted, .at = at});
    active_ = active;
    pulses += active ? 1 : 0;
    return hal::TriggerEdge{at, at};
  }
  std::optional<hal::InputEdge> waitEdge(rt::Nanoseconds timeout) override {
    if (restless) return hal::InputEdge{.active = true, .at = rt::now()};
    if (edges.empty()) {
      drained = true;
      std::this_thread::sleep_for(std::min<rt::Nanoseconds>(timeout, 1ms));
      return std::nullopt;
    }
    const hal::InputEdge edge = edges.front();
    edges.pop_front();
    return edge;
  }
  rt::Result<bool> isActive() override { return active_ != inverted; }

  bool inverted = false;
  bool gone = false;
  bool restless = false;  // edges without end
  int pulses = 0;
  std::atomic<bool> drained{false};
  std::deque<hal::InputEdge> edges;
  bool active_ = false;
};

TEST(Loopback, ChecksTheWireByOnePulseAndLeavesItInactive) {
  Wire wire;
  wire.edges.push_back({.active = true, .at = rt::now()});  // from before: not the pulse's
  const auto checked = checkLoopback(wire, wire);
  EXPECT_TRUE(checked.has_value()) << checked.error();
  EXPECT_EQ(wire.pulses, 1);
  EXPECT_FALSE(wire.active_);
  EXPECT_TRUE(wire.edges.empty()) << "the test's own edges must not be taken for triggers";
}

TEST(Loopback, DoesNotWaitForAnInputThatNeverRests) {
  Wire wire;
  wire.restless = true;
  EXPECT_TRUE(checkLoopback(wire, wire).has_value());
}

TEST(Loopback, FindsWrongPolarityAndADeadLine) {
  Wire wire;
  wire.inverted = true;
  EXPECT_THAT(checkLoopback(wire, wire).error(), HasSubstr("polarity wrong"));
  wire.gone = true;
  EXPECT_THAT(checkLoopback(wire, wire).error(), HasSubstr("is gone"));
}

TEST(Loopback, RecordsWhichTriggerEveryEdgeWas) {
  const test::TemporaryFolder folder;
  auto trace = TraceWriter::open(folder / "trace.jsonl");
  ASSERT_TRUE(trace.has_value()) << trace.error();
  EdgeBoard board;
  constexpr rt::Nanoseconds kPeriod = 25ms;
  const rt::Timestamp start = rt::now();
  Wire wire;
  for (std::uint64_t trigger = 1; trigger <= 10; ++trigger) {
    const rt::Timestamp edge = start + static_cast<std::int64_t>(trigger) * kPeriod;
    board.post(trigger, edge);
    wire.edges.push_back({.active = true, .at = edge + 7us});
    wire.edges.push_back({.active = false, .at = edge + 107us});
  }
  wire.edges.push_back({.active = true, .at = start + 100s});  // a disturbance
  {
    LoopbackLoop loop(kPeriod, wire, board, (*trace)->addProducer("loopback"));
    std::jthread thread([&](const std::stop_token& stop) { loop.run(stop); });
    while (!wire.drained) std::this_thread::sleep_for(1ms);
  }
  (*trace)->begin({});
  ASSERT_TRUE((*trace)->finish({}).has_value());
  const auto read = readTraceFile(folder / "trace.jsonl");
  ASSERT_TRUE(read.has_value()) << read.error();
  ASSERT_EQ(read->loopbacks.size(), 11U);
  for (std::uint64_t trigger = 1; trigger <= 10; ++trigger) {
    const LoopbackRecord& seen = read->loopbacks[trigger - 1];
    EXPECT_EQ(seen.trigger, trigger);
    EXPECT_EQ(seen.edge - board.edge(trigger), 7us);
  }
  EXPECT_EQ(read->loopbacks[10].trigger, 0U);
}

}  // namespace

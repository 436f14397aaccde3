// The far ends of the lines: what records, carries and fires must be right before it judges others.
// In virtual time, so that the instants themselves can be compared.

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/gpio.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/kernel/support/gpio_sim.h"
#include "tests/kernel/support/gpio_trace.h"
#include "tests/kernel/support/gpio_wire.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace std::chrono_literals;

std::int64_t nowNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// One output, driven by the kernel's own interface and nothing of ours.
class Output {
 public:
  Output(const std::string& chip, std::uint32_t offset) : chip_(::open(chip.c_str(), O_RDWR)) {
    gpio_v2_line_request request{};
    request.offsets[0] = offset;
    request.num_lines = 1;
    request.config.flags = GPIO_V2_LINE_FLAG_OUTPUT;
    EXPECT_EQ(::ioctl(chip_, GPIO_V2_GET_LINE_IOCTL, &request), 0) << std::strerror(errno);
    line_ = request.fd;
  }
  ~Output() {
    ::close(line_);
    ::close(chip_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void set(bool level) const {
    gpio_v2_line_values values{.bits = level ? 1U : 0U, .mask = 1};
    EXPECT_EQ(::ioctl(line_, GPIO_V2_LINE_SET_VALUES_IOCTL, &values), 0) << std::strerror(errno);
  }

 private:
  int chip_;
  int line_ = -1;
};

TEST(GpioTrace, RecordsTheInstantOfEveryEdgeToTheNanosecond) {
  test::GpioSim chip("wires", {"OTHER", "PULSE"});
  const std::uint32_t number = test::GpioTrace::numberOf("PULSE");
  test::GpioTrace trace("record");
  const Output other(chip.path(), 0);
  const Output pulse(chip.path(), 1);
  std::vector<std::int64_t> before;
  std::vector<std::int64_t> after;
  for (int i = 1; i <= 300; ++i) {
    before.push_back(nowNs());
    pulse.set(i % 2 == 1);
    after.push_back(nowNs());
    pulse.set(i % 2 == 1);  // no edge
    other.set(i % 2 == 0);
    std::this_thread::sleep_for(3333333ns);
  }
  const std::vector<test::GpioEvent> edges = test::outputEdges(trace.take(), number, false);
  ASSERT_EQ(edges.size(), before.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_EQ(edges[i].level, i % 2 == 0);
    EXPECT_GE(edges[i].time_ns, before[i]);
    EXPECT_LE(edges[i].time_ns, after[i]);
  }
}

TEST(GpioTrace, KeepsTheTimeAcrossLongPauses) {
  test::GpioSim chip("wires", {"PULSE"});
  const std::uint32_t number = test::GpioTrace::numberOf("PULSE");
  test::GpioTrace trace("pauses");
  const Output pulse(chip.path(), 0);
  for (int i = 1; i <= 3; ++i) {
    std::this_thread::sleep_for(1h);
    pulse.set(i % 2 == 1);
  }
  const std::vector<test::GpioEvent> edges = test::outputEdges(trace.take(), number, false);
  ASSERT_EQ(edges.size(), 3U);
  const std::int64_t hour_ns = std::chrono::nanoseconds(1h).count();
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_NEAR(static_cast<double>(edges[i].time_ns - edges[i - 1].time_ns),
                static_cast<double>(hour_ns), 1e9);
  }
}

TEST(GpioTrace, IsNotRobbedByASecondRecorder) {
  test::GpioSim chip("wires", {"PULSE"});
  const std::uint32_t number = test::GpioTrace::numberOf("PULSE");
  test::GpioTrace one("one");
  test::GpioTrace two("two");
  const Output pulse(chip.path(), 0);
  pulse.set(true);
  EXPECT_EQ(test::outputEdges(one.take(), number, false).size(), 1U);
  EXPECT_EQ(test::outputEdges(two.take(), number, false).size(), 1U);
  EXPECT_TRUE(one.take().empty());
}

TEST(GpioWire, PullsTheInputAfterTheOutput) {
  for (const bool inverted : {false, true}) {
    test::GpioSim chip("wires", {"OUT", "IN"});
    const test::GpioWire wire("OUT", test::pullOf(chip.lineFolder("IN"), inverted));
    const Output out(chip.path(), 0);
    for (const bool level : {true, false, true}) {
      out.set(level);
      std::this_thread::sleep_for(20ms);
      EXPECT_EQ(chip.level("IN"), level != inverted);
    }
  }
}

TEST(TriggerBridge, SendsEveryEdgeWithItsInstant) {
  test::GpioSim chip("wires", {"TRIGGER", "LOOP"});
  const std::uint32_t number = test::GpioTrace::numberOf("TRIGGER");
  test::GpioTrace trace("beside-the-bridge");

  const int listener = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof at;
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&at), &length), 0);

  const test::TemporaryFolder folder;
  test::ChildProcess bridge({TRIGGER_BRIDGE, "TRIGGER", std::to_string(ntohs(at.sin_port)),
                             "--loop-back", chip.lineFolder("LOOP")},
                            folder / "bridge.log");
  ASSERT_TRUE(bridge.waitForOutput("ready", 30s)) << bridge.output();
  const Output trigger(chip.path(), 0);
  for (int i = 0; i < 40; ++i) {
    trigger.set(true);
    std::this_thread::sleep_for(100us);  // shorter than the bridge looks
    trigger.set(false);
    std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(chip.level("LOOP"));
  }
  for (const test::GpioEvent& edge : test::outputEdges(trace.take(), number)) {
    std::string text(64, '\0');
    const ssize_t bytes = ::recv(listener, text.data(), text.size(), MSG_DONTWAIT);
    ASSERT_GT(bytes, 0) << "an edge was not sent";
    text.resize(static_cast<std::size_t>(bytes));
    EXPECT_TRUE(text.starts_with(edge.level ? "L1+ " : "L1- ")) << text;
    // Two recorders of one edge read the clock one after the other.
    EXPECT_LE(std::abs(std::stoll(text.substr(4)) - edge.time_ns), 1000) << text;
  }
  char more = 0;
  EXPECT_LT(::recv(listener, &more, 1, MSG_DONTWAIT), 0) << "more was sent than happened";
  ::close(listener);
  bridge.terminate();
  EXPECT_EQ(bridge.wait(20s), 0) << bridge.output();
}

TEST(TriggerBridge, SaysWhichLineIsMissing) {
  const test::TemporaryFolder folder;
  test::ChildProcess bridge({TRIGGER_BRIDGE, "NOWHERE", "3990"}, folder / "bridge.log");
  EXPECT_EQ(bridge.wait(20s), 1);
  EXPECT_THAT(bridge.output(), testing::HasSubstr("no GPIO line is named 'NOWHERE'"));
}

}  // namespace

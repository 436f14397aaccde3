#include "hal/emulated/trigger_line.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include "hal/emulated/rig/socket.h"
#include "hal/emulated/rig/trigger_wire.h"

namespace {

using namespace std::chrono_literals;

/// The far end of a trigger line: what the camera's input sees.
class Observer {
 public:
  virtual ~Observer() = default;
  /// The line's new level, when it changes within a generous time.
  virtual std::optional<bool> waitLevel() = 0;
  /// The instant that a backend's edge carries, where it carries one.
  [[nodiscard]] virtual std::optional<rt::Timestamp> edgeStamp() const { return std::nullopt; }
};

struct Line {
  std::unique_ptr<Observer> observer;
  std::unique_ptr<hal::TriggerLine> line;
};

struct Backend {
  const char* name;
  std::function<Line()> open;
};

class WireObserver final : public Observer {
 public:
  explicit WireObserver(emulator::UniqueFd fd) : fd_(std::move(fd)) {}
  std::optional<bool> waitLevel() override {
    pollfd ready{fd_.get(), POLLIN, 0};
    if (::poll(&ready, 1, 5000) != 1) return std::nullopt;
    char text[64];
    const ssize_t bytes = ::recv(fd_.get(), text, sizeof text, 0);
    if (bytes < 0) return std::nullopt;
    const auto edge = emulator::parseWireEdge({text, static_cast<std::size_t>(bytes)});
    if (!edge) return std::nullopt;
    stamp_ = edge->at;
    return edge->rising;
  }
  [[nodiscard]] std::optional<rt::Timestamp> edgeStamp() const override { return stamp_; }

 private:
  emulator::UniqueFd fd_;
  std::optional<rt::Timestamp> stamp_;
};

Line emulated() {
  auto fd = emulator::bindUdp(INADDR_LOOPBACK, 0, false);
  if (!fd) return {};
  sockaddr_in at{};
  socklen_t length = sizeof at;
  ::getsockname(fd->get(), reinterpret_cast<sockaddr*>(&at), &length);
  auto line = hal::emulated::EmulatedTriggerLine::open(ntohs(at.sin_port));
  if (!line) return {};
  return {std::make_unique<WireObserver>(std::move(*fd)), std::move(*line)};
}

class TriggerLineConformance : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override { ASSERT_TRUE(rig_.line && rig_.observer) << "the backend did not open"; }
  Line rig_ = GetParam().open();
};

TEST_P(TriggerLineConformance, BracketsEveryEdge) {
  for (const bool active : {true, false, true, false}) {
    const rt::Timestamp before = rt::now();
    const auto edge = rig_.line->setActive(active);
    const rt::Timestamp after = rt::now();
    ASSERT_TRUE(edge);
    EXPECT_LE(before, edge->before);
    EXPECT_LE(edge->before, edge->after);
    EXPECT_LE(edge->after, after);
    EXPECT_EQ(rig_.observer->waitLevel(), active);
    if (const auto stamp = rig_.observer->edgeStamp()) {
      EXPECT_GE(*stamp, edge->before);
      EXPECT_LE(*stamp, edge->after);
    }
  }
}

TEST_P(TriggerLineConformance, IsInactiveWhenItGoes) {
  ASSERT_TRUE(rig_.line->setActive(true));
  EXPECT_EQ(rig_.observer->waitLevel(), true);
  rig_.line.reset();
  EXPECT_EQ(rig_.observer->waitLevel(), false);
}

TEST_P(TriggerLineConformance, LosesNoEdgeOfAFastTrain) {
  constexpr int kEdges = 200;
  for (int i = 0; i < kEdges; ++i) ASSERT_TRUE(rig_.line->setActive(i % 2 == 0));
  for (int i = 0; i < kEdges; ++i) ASSERT_EQ(rig_.observer->waitLevel(), i % 2 == 0) << i;
}

INSTANTIATE_TEST_SUITE_P(Backends, TriggerLineConformance,
                         testing::Values(Backend{"Emulated", emulated}),
                         [](const auto& backend) { return backend.param.name; });

TEST(EmulatedTriggerLine, SaysWhenNothingListens) {
  std::uint16_t port = 0;
  {
    const auto fd = emulator::bindUdp(INADDR_LOOPBACK, 0, false);
    ASSERT_TRUE(fd);
    sockaddr_in at{};
    socklen_t length = sizeof at;
    ::getsockname(fd->get(), reinterpret_cast<sockaddr*>(&at), &length);
    port = ntohs(at.sin_port);
  }
  auto line = hal::emulated::EmulatedTriggerLine::open(port);
  ASSERT_TRUE(line);
  (void)(*line)->setActive(true);  // the refusal comes back after the first edge
  const auto edge = (*line)->setActive(true);
  ASSERT_FALSE(edge);
  EXPECT_EQ(edge.error().code, rt::Errc::kDeviceLost);
}

}  // namespace

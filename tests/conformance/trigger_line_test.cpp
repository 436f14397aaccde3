#include "hal/emulated/trigger_line.h"

#include <memory>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include "hal/emulated/rig/socket.h"
#include "hal/emulated/rig/trigger_wire.h"
#include "tests/conformance/trigger_line_suite.h"

namespace test {
namespace {

class WireObserver final : public LineObserver {
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

ObservedLine emulated() {
  auto fd = emulator::bindUdp(INADDR_LOOPBACK, 0, false);
  if (!fd) return {};
  sockaddr_in at{};
  socklen_t length = sizeof at;
  ::getsockname(fd->get(), reinterpret_cast<sockaddr*>(&at), &length);
  auto line = hal::emulated::EmulatedTriggerLine::open(ntohs(at.sin_port));
  if (!line) return {};
  return {std::make_unique<WireObserver>(std::move(*fd)), std::move(*line)};
}

INSTANTIATE_TEST_SUITE_P(Backends, TriggerLineConformance,
                         testing::Values(LineBackend{"Emulated", emulated}),
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
}  // namespace test

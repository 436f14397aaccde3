#include <array>
#include <functional>
#include <map>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "hal/aravis/camera_probe.h"
#include "rt/unique_fd.h"

namespace {

using hal::CameraAnswer;
using namespace std::chrono_literals;

constexpr const char* kAddress = "127.0.6.1";
constexpr std::uint32_t kControlPrivilege = 0xa00;
constexpr std::uint32_t kControllerPort = 0xa04;
constexpr std::uint32_t kControllerAddress = 0xa14;
constexpr auto kLong = 5s;  // far longer than any answer takes

sockaddr_in addressOf(const char* address, std::uint16_t port) {
  sockaddr_in socket_address{};
  socket_address.sin_family = AF_INET;
  socket_address.sin_port = htons(port);
  inet_pton(AF_INET, address, &socket_address.sin_addr);
  return socket_address;
}

rt::UniqueFd boundSocket(const char* address, std::uint16_t port) {
  rt::UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in here = addressOf(address, port);
  EXPECT_EQ(::bind(fd.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here), 0)
      << address << ":" << port << " is taken";
  return fd;
}

/// Answers register reads; a register that it has not is refused.
class Registers {
 public:
  explicit Registers(std::map<std::uint32_t, std::uint32_t> values, bool mute = false)
      : values_(std::move(values)), mute_(mute) {}

 private:
  void serve(const std::stop_token& stop) const {
    while (!stop.stop_requested()) {
      pollfd ready{.fd = fd_.get(), .events = POLLIN, .revents = 0};
      if (::poll(&ready, 1, 20) <= 0) continue;
      std::array<std::uint8_t, 64> question{};
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const auto bytes = ::recvfrom(fd_.get(), question.data(), question.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from), &size);
      if (bytes != 12 || mute_) continue;
      const std::uint32_t address =
          std::uint32_t{question[10]} << 8 | question[11];  // the upper half is zero
      const auto found = values_.find(address);
      const std::uint32_t value = found == values_.end() ? 0 : found->second;
      const auto byte = [&](int shift) { return static_cast<std::uint8_t>(value >> shift & 0xff); };
      // First what a busy camera sends, and another question's answer.
      send({0, 0, 0, 0x89, 0, 4, question[6], question[7], 0, 0, 0, 50}, from);
      send({0, 0, 0, 0x81, 0, 4, 0xff, 0xff, 0, 0, 0, 0}, from);
      if (found == values_.end()) {
        send({0x80, 0x03, 0, 0x81, 0, 0, question[6], question[7]}, from);
      } else {
        send({0, 0, 0, 0x81, 0, 4, question[6], question[7], byte(24), byte(16), byte(8), byte(0)},
             from);
      }
    }
  }
  void send(const std::vector<std::uint8_t>& datagram, const sockaddr_in& to) const {
    (void)::sendto(fd_.get(), datagram.data(), datagram.size(), 0,
                   reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  std::map<std::uint32_t, std::uint32_t> values_;
  bool mute_;
  rt::UniqueFd fd_ = boundSocket(kAddress, 3956);
  std::jthread thread_{[this](const std::stop_token& stop) { serve(stop); }};
};

TEST(CameraProbe, SaysWhenNothingAnswersAndDoesNotWaitLonger) {
  EXPECT_EQ(hal::aravis::probeCamera(kAddress, 100ms).answer, CameraAnswer::kNone);
  EXPECT_EQ(hal::aravis::probeCamera("not an address", kLong).answer, CameraAnswer::kNone);
  const Registers mute({}, true);
  const auto begin = rt::now();
  EXPECT_EQ(hal::aravis::probeCamera(kAddress, 100ms).answer, CameraAnswer::kNone);
  EXPECT_GE(rt::now() - begin, 100ms);
  EXPECT_LT(rt::now() - begin, kLong);
}

TEST(CameraProbe, SaysWhenACameraIsFree) {
  const Registers camera({{kControlPrivilege, 0}});
  EXPECT_EQ(hal::aravis::probeCamera(kAddress, kLong).answer, CameraAnswer::kFree);
}

TEST(CameraProbe, NamesTheControllerWhereTheCameraTells) {
  const Registers camera(
      {{kControlPrivilege, 2}, {kControllerAddress, 0x0a000005}, {kControllerPort, 40000}});
  const auto probe = hal::aravis::probeCamera(kAddress, kLong);
  EXPECT_EQ(probe.answer, CameraAnswer::kHeld);
  EXPECT_EQ(probe.controller, "10.0.0.5");
}

TEST(CameraProbe, CallsACameraHeldThatDoesNotTellItsController) {
  const Registers camera({{kControlPrivilege, 2}});
  const auto probe = hal::aravis::probeCamera(kAddress, kLong);
  EXPECT_EQ(probe.answer, CameraAnswer::kHeld);
  EXPECT_EQ(probe.controller, "");
}

TEST(CameraProbe, CallsACameraHeldThatLetsNobodyRead) {
  const Registers camera({});
  EXPECT_EQ(hal::aravis::probeCamera(kAddress, kLong).answer, CameraAnswer::kHeld);
}

TEST(CameraProbe, KnowsACameraThatThisProcessControls) {
  const rt::UniqueFd control = boundSocket("127.0.0.1", 0);
  sockaddr_in here{};
  socklen_t size = sizeof here;
  ASSERT_EQ(getsockname(control.get(), reinterpret_cast<sockaddr*>(&here), &size), 0);
  const Registers camera({{kControlPrivilege, 2},
                          {kControllerAddress, 0x7f000001},
                          {kControllerPort, ntohs(here.sin_port)}});
  EXPECT_EQ(hal::aravis::probeCamera(kAddress, kLong).answer, CameraAnswer::kOurs);
}

}  // namespace

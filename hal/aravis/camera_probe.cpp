#include "hal/aravis/camera_probe.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <optional>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "hal/aravis/stream_socket.h"
#include "rt/unique_fd.h"

namespace hal::aravis {
namespace {

// GigE Vision's bootstrap registers. A camera need not have the two that name its controller.
constexpr std::uint32_t kControlPrivilege = 0x0a00;
constexpr std::uint32_t kControllerPort = 0x0a04;
constexpr std::uint32_t kControllerAddress = 0x0a14;
constexpr std::uint32_t kControlled = 0x3;  // bits of kControlPrivilege: exclusive, control

constexpr std::uint16_t kPort = 3956;
constexpr std::uint8_t kKey = 0x42;
constexpr std::uint8_t kWantsAnswer = 0x01;
constexpr std::uint16_t kReadRegister = 0x0080;
constexpr std::uint16_t kReadRegisterAnswer = 0x0081;
constexpr std::size_t kHeaderBytes = 8;

constexpr std::uint8_t high(std::uint32_t word) {
  return static_cast<std::uint8_t>(word >> 8 & 0xff);
}
constexpr std::uint8_t low(std::uint32_t word) {
  return static_cast<std::uint8_t>(word & 0xff);
}

struct RegisterAnswer {
  bool refused = false;
  std::uint32_t value = 0;
};

/// A conversation with one camera until @p deadline.
class RegisterReader {
 public:
  RegisterReader(const std::string& address, rt::Timestamp deadline) : deadline_(deadline) {
    sockaddr_in camera{};
    camera.sin_family = AF_INET;
    camera.sin_port = htons(kPort);
    if (inet_pton(AF_INET, address.c_str(), &camera.sin_addr) != 1) return;
    socket_ = rt::UniqueFd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    // Connected: another machine's datagrams stay out, and a closed port is reported as an error.
    connected_ = socket_.get() >= 0 &&
                 ::connect(socket_.get(), reinterpret_cast<sockaddr*>(&camera), sizeof camera) == 0;
  }

  /// Nothing when no answer came in time.
  [[nodiscard]] std::optional<RegisterAnswer> read(std::uint32_t address) {
    if (!connected_) return std::nullopt;
    ++request_;  // from 1: cameras ignore requests without a number
    const std::array<std::uint8_t, kHeaderBytes + 4> question = {kKey,
                                                                 kWantsAnswer,
                                                                 high(kReadRegister),
                                                                 low(kReadRegister),
                                                                 0,
                                                                 4,
                                                                 high(request_),
                                                                 low(request_),
                                                                 high(address >> 16),
                                                                 low(address >> 16),
                                                                 high(address),
                                                                 low(address)};
    if (::send(socket_.get(), question.data(), question.size(), 0) < 0) return std::nullopt;
    while (waitForDatagram()) {
      std::array<std::uint8_t, 576> datagram{};
      const auto bytes = ::recv(socket_.get(), datagram.data(), datagram.size(), 0);
      if (bytes < 0 && errno != EAGAIN) return std::nullopt;  // the port is closed
      if (bytes < static_cast<ssize_t>(kHeaderBytes)) continue;
      const auto word = [&](std::size_t at) {
        return static_cast<std::uint32_t>(datagram[at] << 8 | datagram[at + 1]);
      };
      // A camera that is busy announces its answer by another kind of datagram: waited through.
      if (word(2) != kReadRegisterAnswer || word(6) != request_) continue;
      if (word(0) != 0 || bytes < static_cast<ssize_t>(kHeaderBytes + 4)) {
        return RegisterAnswer{.refused = true};
      }
      return RegisterAnswer{.value = word(8) << 16 | word(10)};
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool waitForDatagram() const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - rt::now()).count();
    pollfd ready{.fd = socket_.get(), .events = POLLIN, .revents = 0};
    return left > 0 && ::poll(&ready, 1, static_cast<int>(left)) > 0;
  }

  rt::Timestamp deadline_;
  rt::UniqueFd socket_;
  bool connected_ = false;
  std::uint16_t request_ = 0;
};

std::string dotted(std::uint32_t address) {
  const in_addr network{htonl(address)};
  std::array<char, INET_ADDRSTRLEN> text{};
  return inet_ntop(AF_INET, &network, text.data(), text.size()) != nullptr ? text.data() : "";
}

}  // namespace

CameraProbe probeCamera(const std::string& address, rt::Nanoseconds timeout) {
  RegisterReader camera(address, rt::now() + timeout);
  const auto privilege = camera.read(kControlPrivilege);
  if (!privilege) return {.answer = CameraAnswer::kNone, .controller = {}};
  // Under exclusive control some cameras refuse every other reader.
  if (!privilege->refused && (privilege->value & kControlled) == 0) {
    return {.answer = CameraAnswer::kFree, .controller = {}};
  }
  const auto controller = camera.read(kControllerAddress);
  if (!controller || controller->refused || controller->value == 0) {
    return {.answer = CameraAnswer::kHeld, .controller = {}};
  }
  const auto port = camera.read(kControllerPort);
  const std::string holder = dotted(controller->value);
  const bool ours = port && !port->refused && isLocalAddress(holder) &&
                    ownsUdpPort(static_cast<std::uint16_t>(port->value & 0xffff));
  return {.answer = ours ? CameraAnswer::kOurs : CameraAnswer::kHeld, .controller = holder};
}

}  // namespace hal::aravis

#include "hal/emulated/trigger_line.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hal::emulated {

std::expected<std::unique_ptr<EmulatedTriggerLine>, std::string> EmulatedTriggerLine::open(
    std::uint16_t port) {
  const auto refused = [port] {
    return std::unexpected("trigger wire 127.0.0.1:" + std::to_string(port) +
                           " cannot be reached: " + std::strerror(errno));
  };
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return refused();
  std::unique_ptr<EmulatedTriggerLine> line(new EmulatedTriggerLine(fd));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) return refused();
  return line;
}

EmulatedTriggerLine::~EmulatedTriggerLine() {
  if (active_) (void)setActive(false);
  ::close(fd_);
}

rt::Result<TriggerEdge> EmulatedTriggerLine::setActive(bool active) RT_SAFE {
  std::array<char, 32> text = {'L', '1', active ? '+' : '-', ' '};
  const rt::Timestamp before = rt::now();
  const auto [end, error] =
      std::to_chars(text.data() + 4, text.data() + text.size(), std::int64_t{rt::toNs(before)});
  (void)error;  // 28 characters hold every 64-bit number
  const auto bytes = static_cast<std::size_t>(end - text.data());
  // A refusal (ECONNREFUSED) is the answer to an earlier edge that no receiver took.
  const ssize_t sent = ::send(fd_, text.data(), bytes, 0);
  const rt::Timestamp after = rt::now();
  if (sent < 0) {
    const bool full = errno == EAGAIN || errno == ENOBUFS;
    return std::unexpected(rt::Error{full ? rt::Errc::kBusy : rt::Errc::kDeviceLost, errno,
                                     "send an edge on the trigger wire"});
  }
  active_ = active;
  return TriggerEdge{before, after};
}

}  // namespace hal::emulated

#include "tests/soak/fault_port.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

namespace soak {

std::expected<FaultPort, std::string> FaultPort::open(std::uint16_t port) {
  rt::UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  constexpr timeval kPatience{.tv_sec = 1, .tv_usec = 0};
  if (!fd.valid() || ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0 ||
      ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience) != 0)
    return std::unexpected(std::string("no socket to the fault port: ") + std::strerror(errno));
  return FaultPort(std::move(fd));
}

std::expected<void, std::string> FaultPort::command(std::uint32_t camera,
                                                    std::string_view fault) const {
  const std::string text = std::to_string(camera + 1) + " " + std::string(fault);
  std::array<char, 512> answer{};
  if (::send(fd_.get(), text.data(), text.size(), 0) < 0)
    return std::unexpected("fault \"" + text + "\" cannot be sent: " + std::strerror(errno));
  const ssize_t bytes = ::recv(fd_.get(), answer.data(), answer.size(), 0);
  if (bytes < 0)
    return std::unexpected("fault \"" + text +
                           "\": the emulator does not answer: " + std::strerror(errno));
  std::string_view said(answer.data(), static_cast<std::size_t>(bytes));
  while (said.ends_with('\n')) said.remove_suffix(1);
  if (said != "ok") return std::unexpected("fault \"" + text + "\": " + std::string(said));
  return {};
}

}  // namespace soak

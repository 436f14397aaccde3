#include "hal/emulated/rig/fault_port.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace emulator {
namespace {

constexpr int kAnswerWithin_ms = 2000;

}  // namespace

std::expected<FaultPort, std::string> FaultPort::open(std::uint32_t address, std::uint16_t port) {
  auto socket = bindUdp(address, port, false);
  if (!socket) return std::unexpected("fault port: " + socket.error() + "; or --fault-port");
  return FaultPort(std::move(*socket));
}

void FaultPort::serve(std::uint32_t cameras,
                      const std::function<void(const FaultCommand&)>& apply) {
  std::array<char, 512> datagram;
  sockaddr_in from{};
  socklen_t length = sizeof from;
  ssize_t bytes = 0;
  while ((bytes = ::recvfrom(socket_.get(), datagram.data(), datagram.size(), 0,
                             reinterpret_cast<sockaddr*>(&from), &length)) >= 0) {
    const auto command =
        parseFaultCommand({datagram.data(), static_cast<std::size_t>(bytes)}, cameras);
    if (command) apply(*command);
    const std::string answer = command ? "ok" : "error: " + command.error();
    // An answer that does not go out is missed by its asker, who says so.
    (void)::sendto(socket_.get(), answer.data(), answer.size(), 0,
                   reinterpret_cast<const sockaddr*>(&from), length);
    length = sizeof from;
  }
}

std::expected<std::string, std::string> commandFault(std::uint32_t address, std::uint16_t port,
                                                     std::string_view command) {
  const std::string where = addressText(address) + " UDP port " + std::to_string(port);
  const UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(address);
  if (fd.get() < 0 || ::connect(fd.get(), reinterpret_cast<sockaddr*>(&to), sizeof to) != 0 ||
      ::send(fd.get(), command.data(), command.size(), 0) < 0) {
    return std::unexpected(where + " cannot be reached: " + std::strerror(errno));
  }
  std::array<char, 512> answer;
  pollfd ready{fd.get(), POLLIN, 0};
  const bool heard = ::poll(&ready, 1, kAnswerWithin_ms) == 1;
  const ssize_t bytes = heard ? ::recv(fd.get(), answer.data(), answer.size(), 0) : -1;
  if (bytes < 0) {
    return std::unexpected(where +
                           " does not answer: start kagami-emulator first, and give its "
                           "--first-address and --fault-port");
  }
  return std::string(answer.data(), static_cast<std::size_t>(bytes));
}

}  // namespace emulator

#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace test {

/// Gives the emulator at @p address one command, "7 kill"; its answer, "ok" when it was taken,
/// empty when none came.
[[nodiscard]] inline std::string sendFault(const std::string& address, std::uint16_t port,
                                           const std::string& command) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  inet_pton(AF_INET, address.c_str(), &to.sin_addr);
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const timeval patience{.tv_sec = 10, .tv_usec = 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  (void)::sendto(fd, command.data(), command.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                 sizeof to);
  std::array<char, 256> answer{};
  const auto bytes = ::recv(fd, answer.data(), answer.size() - 1, 0);
  ::close(fd);
  std::string text = bytes > 0 ? answer.data() : "";
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

}  // namespace test

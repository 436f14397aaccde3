#include "hal/emulated/rig/socket.h"

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace emulator {
namespace {

constexpr int kBufferBytes = 4 << 20;

std::string bindError(std::uint32_t address, std::uint16_t port, int error) {
  const std::string where = addressText(address) + " UDP port " + std::to_string(port);
  if (error == EADDRINUSE) {
    return where +
           " is in use: another emulated or fake camera runs; find it with ss -ulpn "
           "'sport = :" +
           std::to_string(port) + "' and stop it, or choose another --first-address or --wire-port";
  }
  if (error == EADDRNOTAVAIL) {
    return where + ": this machine does not have the address; choose another --first-address";
  }
  return where + " cannot be opened: " + std::strerror(error);
}

}  // namespace

std::string addressText(std::uint32_t address) {
  const in_addr raw{htonl(address)};
  char text[INET_ADDRSTRLEN] = {};
  ::inet_ntop(AF_INET, &raw, text, sizeof text);
  return text;
}

std::expected<std::uint32_t, std::string> parseAddress(const std::string& text) {
  in_addr raw{};
  if (::inet_pton(AF_INET, text.c_str(), &raw) != 1) {
    return std::unexpected("'" + text + "' is not an IPv4 address like 127.0.0.1");
  }
  return ntohl(raw.s_addr);
}

std::expected<UniqueFd, std::string> bindUdp(std::uint32_t address, std::uint16_t port,
                                             bool shared) {
  UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (fd.get() < 0) return std::unexpected(bindError(address, port, errno));
  const int one = 1;
  if (shared) ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &one, sizeof one);
  // As large as the system allows; a smaller buffer only makes a late sender visible sooner.
  ::setsockopt(fd.get(), SOL_SOCKET, SO_SNDBUF, &kBufferBytes, sizeof kBufferBytes);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  at.sin_addr.s_addr = htonl(address);
  if (::bind(fd.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) {
    return std::unexpected(bindError(address, port, errno));
  }
  return fd;
}

}  // namespace emulator

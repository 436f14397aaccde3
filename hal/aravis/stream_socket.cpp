#include "hal/aravis/stream_socket.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "rt/unique_fd.h"

namespace hal::aravis {
namespace {

bool isUdpSocketOn(int fd, std::uint16_t port) {
  int type = 0;
  socklen_t type_size = sizeof type;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM) {
    return false;
  }
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;
  auto* address = reinterpret_cast<sockaddr*>(&storage);
  if (getsockname(fd, address, &size) != 0 || storage.ss_family != AF_INET) return false;
  return ntohs(reinterpret_cast<const sockaddr_in*>(address)->sin_port) == port;
}

/// This process's UDP socket bound to @p port; -1: it has none.
int findUdpSocket(std::uint16_t port) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename();
    int fd = -1;
    std::from_chars(name.data(), name.data() + name.size(), fd);
    if (fd >= 0 && isUdpSocketOn(fd, port)) return fd;
  }
  return -1;
}

}  // namespace

int sizeReceiveBuffer(std::uint16_t port, int bytes) {
  const int fd = findUdpSocket(port);
  if (fd < 0) return 0;
  // FORCE passes the system's limit where we are privileged.
  if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0) {
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  }
  int doubled = 0;  // the kernel reports twice the payload, its bookkeeping included
  socklen_t size = sizeof doubled;
  getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &doubled, &size);
  return doubled / 2;
}

bool ownsUdpPort(std::uint16_t port) {
  return findUdpSocket(port) >= 0;
}

std::string localAddressTowards(const std::string& address) {
  sockaddr_in far{};
  far.sin_family = AF_INET;
  far.sin_port = htons(1);  // any: connecting a datagram socket sends nothing
  if (inet_pton(AF_INET, address.c_str(), &far.sin_addr) != 1) return {};
  const rt::UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in here{};
  socklen_t size = sizeof here;
  std::array<char, INET_ADDRSTRLEN> text{};
  if (!fd.valid() || ::connect(fd.get(), reinterpret_cast<sockaddr*>(&far), sizeof far) != 0 ||
      getsockname(fd.get(), reinterpret_cast<sockaddr*>(&here), &size) != 0 ||
      inet_ntop(AF_INET, &here.sin_addr, text.data(), text.size()) == nullptr) {
    return {};
  }
  return text.data();
}

bool isLocalAddress(const std::string& address) {
  // From one of its own addresses a machine reaches that address.
  return !address.empty() && localAddressTowards(address) == address;
}

}  // namespace hal::aravis

#include "hal/aravis/stream_socket.h"

#include <charconv>
#include <filesystem>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

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

}  // namespace

int sizeReceiveBuffer(std::uint16_t port, int bytes) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename();
    int fd = -1;
    std::from_chars(name.data(), name.data() + name.size(), fd);
    if (fd < 0 || !isUdpSocketOn(fd, port)) continue;
    // FORCE passes the system's limit where we are privileged.
    if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0) {
      setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    }
    int doubled = 0;  // the kernel reports twice the payload, its bookkeeping included
    socklen_t size = sizeof doubled;
    getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &doubled, &size);
    return doubled / 2;
  }
  return 0;
}

}  // namespace hal::aravis

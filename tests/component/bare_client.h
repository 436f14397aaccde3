#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/gvcp.h"
#include "rt/unique_fd.h"

namespace test {

/// A client that speaks GVCP by hand, to fall silent as Aravis never does.
class BareClient {
 public:
  explicit BareClient(const std::string& address)
      : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(emulator::gvcp::kPort);
    ::inet_pton(AF_INET, address.c_str(), &to.sin_addr);
    (void)::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  /// The status of a register write; nothing without an answer.
  std::optional<std::uint16_t> write(std::uint32_t address, std::uint32_t value) {
    std::array<std::uint8_t, 16> bytes = {0x42, 1, 0, 0x82, 0, 8, 0, 1};
    emulator::storeBe32(&bytes[8], address);
    emulator::storeBe32(&bytes[12], value);
    (void)::send(fd_.get(), bytes.data(), bytes.size(), 0);
    pollfd ready{fd_.get(), POLLIN, 0};
    if (::poll(&ready, 1, 5000) != 1 || ::recv(fd_.get(), bytes.data(), bytes.size(), 0) < 8) {
      return std::nullopt;
    }
    return emulator::loadBe16(bytes.data());
  }

 private:
  rt::UniqueFd fd_;
};

}  // namespace test

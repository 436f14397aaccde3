#pragma once

#include <cstdint>
#include <string>

namespace hal::aravis {

/// Sizes the receive buffer of this process's UDP socket bound to @p port and returns the
/// size in force (0: no such socket). Aravis applies its own option only when the first
/// packet has come, so the first frame would overflow the system's default buffer.
int sizeReceiveBuffer(std::uint16_t port, int bytes);

/// Whether a UDP socket of this process is bound to @p port.
[[nodiscard]] bool ownsUdpPort(std::uint16_t port);

/// The address (IPv4) of this machine from which the routes lead to @p address; empty: none do.
[[nodiscard]] std::string localAddressTowards(const std::string& address);

/// Whether @p address (IPv4) is one of this machine's own.
[[nodiscard]] bool isLocalAddress(const std::string& address);

}  // namespace hal::aravis

#pragma once

#include <cstdint>

namespace hal::aravis {

/// Sizes the receive buffer of this process's UDP socket bound to @p port and returns the
/// size in force (0: no such socket). Aravis applies its own option only when the first
/// packet has come, so the first frame would overflow the system's default buffer.
int sizeReceiveBuffer(std::uint16_t port, int bytes);

}  // namespace hal::aravis

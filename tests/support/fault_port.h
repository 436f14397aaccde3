#pragma once

#include <cstdint>
#include <string>

#include "hal/emulated/rig/fault_port.h"
#include "hal/emulated/rig/socket.h"

namespace test {

/// Gives the emulator at @p address one command, "7 kill": "ok" when it was taken, else what was
/// wrong.
[[nodiscard]] inline std::string sendFault(const std::string& address, std::uint16_t port,
                                           const std::string& command) {
  const auto to = emulator::parseAddress(address);
  if (!to) return to.error();
  const auto answer = emulator::commandFault(*to, port, command);
  return answer ? *answer : answer.error();
}

}  // namespace test

#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <string>
#include <string_view>

#include "hal/emulated/rig/fault_command.h"
#include "hal/emulated/rig/socket.h"

namespace emulator {

inline constexpr std::uint16_t kDefaultFaultPort = 3991;

/// Where faults are commanded: UDP, one command per datagram, answered with "ok" or
/// "error: <what is wrong>".
class FaultPort {
 public:
  /// @p address: host order.
  [[nodiscard]] static std::expected<FaultPort, std::string> open(std::uint32_t address,
                                                                  std::uint16_t port);

  [[nodiscard]] int fd() const { return socket_.get(); }

  /// Serves every datagram that waits: hands well-formed commands to @p apply and answers.
  void serve(std::uint32_t cameras, const std::function<void(const FaultCommand&)>& apply);

 private:
  explicit FaultPort(UniqueFd socket) : socket_(std::move(socket)) {}
  UniqueFd socket_;
};

/// Sends one command to a running emulator's fault port and returns its answer. An error if no
/// emulator answered.
[[nodiscard]] std::expected<std::string, std::string> commandFault(std::uint32_t address,
                                                                   std::uint16_t port,
                                                                   std::string_view command);

}  // namespace emulator

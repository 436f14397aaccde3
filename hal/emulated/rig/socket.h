#pragma once

#include <cstdint>
#include <expected>
#include <string>

#include "rt/unique_fd.h"

namespace emulator {

using rt::UniqueFd;

/// "127.0.0.7" from a host-order address and back.
[[nodiscard]] std::string addressText(std::uint32_t address);
[[nodiscard]] std::expected<std::uint32_t, std::string> parseAddress(const std::string& text);

/// A UDP socket that does not block, bound to @p address (host order) and @p port (0: any).
/// @p shared lets several programs answer the same broadcast. An error says who may hold
/// the port and what to do.
[[nodiscard]] std::expected<UniqueFd, std::string> bindUdp(std::uint32_t address,
                                                           std::uint16_t port, bool shared);

}  // namespace emulator

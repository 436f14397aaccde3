#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

#include "rt/unique_fd.h"

namespace soak {

/// The near end of kagami-emulator's fault port.
class FaultPort {
 public:
  [[nodiscard]] static std::expected<FaultPort, std::string> open(std::uint16_t port);

  /// @p camera from 0. Errors: what the emulator answered, or that it did not within a second.
  [[nodiscard]] std::expected<void, std::string> command(std::uint32_t camera,
                                                         std::string_view fault) const;

 private:
  explicit FaultPort(rt::UniqueFd fd) : fd_(std::move(fd)) {}
  rt::UniqueFd fd_;
};

}  // namespace soak

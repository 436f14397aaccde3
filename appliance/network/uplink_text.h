#pragma once

#include <cstdint>
#include <expected>
#include <string>

namespace appliance {

struct Uplinks {
  std::uint32_t count = 1;
  double gbps = 10;
  bool operator==(const Uplinks&) const = default;
};

/// "10G", "2x10G", "2.5G" or "100M". Errors: one line.
[[nodiscard]] std::expected<Uplinks, std::string> parseUplinks(const std::string& text);

}  // namespace appliance

#pragma once

#include <cstdint>

namespace appliance {

class Section;

/// The cameras' way into this machine.
struct NetworkSettings {
  std::uint32_t uplinks = 2;
  double uplink_gbps = 10;
  double camera_link_gbps = 1;
  bool operator==(const NetworkSettings&) const = default;
};

/// Reads `[network]`.
void read(Section section, NetworkSettings& network);

}  // namespace appliance

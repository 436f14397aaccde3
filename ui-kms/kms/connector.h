#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <xf86drmMode.h>

#include "ui-kms/kms/properties.h"

namespace ui::kms {

enum class Probe : std::uint8_t {
  kKnown,   ///< what the kernel knows: quick
  kSearch,  ///< asks the screens themselves: reading an EDID takes tens of milliseconds
};

/// Where a screen plugs in, as it was at one instant.
struct Connector {
  std::uint32_t id = 0;
  std::string name;  ///< "HDMI-A-1"
  bool connected = false;
  std::vector<drmModeModeInfo> modes;  ///< the screen's, in its own order
  std::vector<std::uint32_t> encoders;
  Properties properties;

  /// False: the cable's link went bad after the mode was set, and the mode must be set again.
  [[nodiscard]] bool linkGood() const { return properties.value("link-status").value_or(0) == 0; }
};

/// None: it vanished.
[[nodiscard]] std::optional<Connector> readConnector(int fd, std::uint32_t id, Probe probe);

/// The first one with a screen that people look at; one that offers modes goes first.
[[nodiscard]] std::optional<Connector> findConnector(int fd, Probe probe);

}  // namespace ui::kms

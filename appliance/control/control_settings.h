#pragma once

#include <string>

namespace appliance {

class Section;

/// Where the daemon is found on D-Bus.
struct ControlSettings {
  std::string bus = "system";  ///< system, session, none or a D-Bus address
  std::string name = "org.kagami.Kagami1";
  bool operator==(const ControlSettings&) const = default;
};

/// Reads `[control]`.
void read(Section section, ControlSettings& control);

}  // namespace appliance

#pragma once

#include <string>

namespace appliance {

class Section;

/// Where the rig is loaded from.
struct RigSettings {
  std::string file = "/etc/kagami/rig.toml";
  bool operator==(const RigSettings&) const = default;
};

/// Reads `[rig]`.
void read(Section section, RigSettings& rig);

}  // namespace appliance

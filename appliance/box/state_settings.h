#pragma once

#include <string>

namespace appliance {

class Section;

/// Where the box writes.
struct StateSettings {
  std::string directory = "/var/lib/kagami";
  std::string trace;  ///< empty: no trace is written
  bool operator==(const StateSettings&) const = default;
};

/// Reads `[state]`.
void read(Section section, StateSettings& state);

}  // namespace appliance

#pragma once

namespace appliance {

class Section;

/// What lights the hall.
struct LightSettings {
  double mains_hz = 50;
  bool operator==(const LightSettings&) const = default;
};

/// Reads `[light]`.
void read(Section section, LightSettings& light);

}  // namespace appliance

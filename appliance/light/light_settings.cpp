#include "appliance/light/light_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, LightSettings& light) {
  section.number("mains_hz", light.mains_hz, {10, 100, "Hz"});
  section.end();
}

}  // namespace appliance

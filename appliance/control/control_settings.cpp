#include "appliance/control/control_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, ControlSettings& control) {
  section.word("bus", control.bus);
  section.word("name", control.name);
  section.end();
}

}  // namespace appliance

#include "appliance/box/state_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, StateSettings& state) {
  section.word("directory", state.directory);
  section.text("trace", state.trace);
  section.end();
}

}  // namespace appliance

#include "appliance/site/rig_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, RigSettings& rig) {
  section.word("file", rig.file);
  section.end();
}

}  // namespace appliance

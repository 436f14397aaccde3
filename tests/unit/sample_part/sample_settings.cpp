#include "tests/unit/sample_part/sample_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, SampleSettings& sample) {
  section.flag("enabled", sample.enabled);
  section.milliseconds("period_ms", sample.period, {1, 1000, "ms"});
  section.end();
}

}  // namespace appliance

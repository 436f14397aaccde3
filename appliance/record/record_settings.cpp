#include "appliance/record/record_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, RecordSettings& record) {
  section.text("directory", record.directory);
  section.number("video_hz", record.video_hz, {1, 240, "Hz"});
  section.integer("video_width_px", record.video_width_px, {64, 7680, "px"});
  section.end();
}

}  // namespace appliance

#include "appliance/render/display_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, DisplaySettings& display) {
  section.word("backend", display.backend);
  section.text("device", display.device);
  section.text("mode", display.mode);
  section.integer("queue_depth", display.queue_depth, {1, 2, "pictures"});
  section.integer("width_px", display.width_px, {64, 7680, "px"});
  section.integer("height_px", display.height_px, {64, 4320, "px"});
  section.number("refresh_hz", display.refresh_hz, {1, 480, "Hz"});
  section.integer("rotation_deg", display.rotation_deg, {0, 270, "degrees"});
  if (display.rotation_deg % 90 != 0) {
    section.fail("rotation_deg", "rotation_deg must be 0, 90, 180 or 270");
  }
  section.numberOrWord("zoom", display.zoom, {0.1, 20}, "cover");
  section.integer("render_threads", display.render_threads, {1, 64, "threads"});
  section.word("font", display.font);
  section.flag("flicker_compensation", display.flicker_compensation);
  section.end();
}

}  // namespace appliance

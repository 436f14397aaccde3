#include "appliance/depth/depth_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, DepthSettings& sensor) {
  section.word("backend", sensor.backend);
  section.text("source", sensor.device.source);
  section.text("drivers", sensor.device.drivers);
  section.integer("width_px", sensor.device.width_px, {64, 4096, "px"});
  section.integer("height_px", sensor.device.height_px, {64, 4096, "px"});
  section.integer("rate_hz", sensor.device.rate_hz, {1, 240, "Hz"});
  section.flag("colour", sensor.device.colour);
  section.milliseconds("latency_ms", sensor.device.latency, {0, 1000, "ms"});
  section.flag("repeat", sensor.device.repeat);
  section.end();
}

}  // namespace appliance

#include "appliance/panel/panel_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, PanelSettings& panel) {
  section.word("backend", panel.backend);
  section.text("script", panel.device.script);
  section.text("button_prefix", panel.device.button_prefix);
  section.text("lamp_prefix", panel.device.lamp_prefix);
  section.flag("active_low", panel.device.active_low);
  section.milliseconds("debounce_ms", panel.device.debounce, {1, 100, "ms"});
  section.end();
  if (panel.device.button_prefix == panel.device.lamp_prefix)
    section.fail("lamp_prefix", "lamp_prefix must differ from button_prefix");
}

}  // namespace appliance

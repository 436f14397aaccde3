#include "appliance/panel/panel_settings.h"

#include <chrono>

namespace appliance {

hal::PanelSettings panelSettings(const Config::Panel& config) {
  return {.script = config.script,
          .button_prefix = config.button_prefix,
          .lamp_prefix = config.lamp_prefix,
          .active_low = config.active_low,
          .debounce = std::chrono::milliseconds(config.debounce_ms)};
}

}  // namespace appliance

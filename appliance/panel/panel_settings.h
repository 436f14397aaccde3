#pragma once

#include <string>

#include "hal/button_panel.h"

namespace appliance {

class Section;

struct PanelSettings {
  std::string backend = "none";
  hal::PanelSettings device;
  bool operator==(const PanelSettings&) const = default;
};

/// Reads `[panel]`.
void read(Section section, PanelSettings& panel);

}  // namespace appliance

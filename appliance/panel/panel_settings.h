#pragma once

#include "appliance/config/config.h"
#include "hal/backends.h"

namespace appliance {

/// The configuration in the panel's own terms.
[[nodiscard]] hal::PanelSettings panelSettings(const Config::Panel& config);

}  // namespace appliance

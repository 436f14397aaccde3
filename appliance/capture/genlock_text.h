#pragma once

#include <string>

#include "appliance/capture/genlock_status.h"

namespace appliance {

/// One line for a person: how the triggers stand to the screen, why, and what to do.
[[nodiscard]] std::string genlockText(const GenlockStatus& status, double trigger_hz);

}  // namespace appliance

#pragma once

#include <expected>
#include <string>

#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"

namespace appliance {

/// What neither file can know alone: whether configuration and rig describe the same box.
/// Errors   One line: what does not fit, and where to change it.
[[nodiscard]] std::expected<void, std::string> checkTogether(const Config& config, const Rig& rig);

}  // namespace appliance

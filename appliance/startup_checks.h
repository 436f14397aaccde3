#pragma once

#include <expected>
#include <string>

#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"

namespace appliance {

/// What neither file can know alone: whether configuration and rig describe the same box.
/// Errors   One line: what does not fit, and where to change it.
[[nodiscard]] std::expected<void, std::string> checkTogether(const Config& config, const Rig& rig);

/// How far the athlete smears across a picture during one exposure, for the log:
/// "exposure 1.00 ms: motion blur at 20 m/s is 20 mm (5.9 px)".
[[nodiscard]] std::string motionBlurLine(const Config& config, const Rig& rig);

}  // namespace appliance

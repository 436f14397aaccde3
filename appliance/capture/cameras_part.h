#pragma once

#include "appliance/box/part.h"

namespace appliance {

/// All cameras of the rig: received, stored, watched. They wait for the trigger.
[[nodiscard]] MadePart makeCamerasPart(const Shared& shared);

}  // namespace appliance

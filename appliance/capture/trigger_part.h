#pragma once

#include "appliance/box/part.h"

namespace appliance {

/// Fires the cameras, and where a loop-back is wired measures the edges that left.
[[nodiscard]] MadePart makeTriggerPart(const Shared& shared);

}  // namespace appliance

#pragma once

#include "appliance/box/part.h"

namespace appliance {

/// The depth sensor, section "depth" of the status. Null without a backend.
[[nodiscard]] MadePart makeDepthPart(const Shared& shared);

}  // namespace appliance

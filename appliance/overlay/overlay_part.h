#pragma once

#include "appliance/box/part.h"

namespace appliance {

/// Makes what is drawn over the views, on the `ui` thread. Null where the display has no font.
[[nodiscard]] MadePart makeOverlayPart(const Shared& shared);

}  // namespace appliance

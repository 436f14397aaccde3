#pragma once

#include "appliance/box/part.h"

namespace appliance {

/// The panel: its buttons become commands, its lamps follow the mode. Null without a backend.
[[nodiscard]] MadePart makePanelPart(const Shared& shared);

}  // namespace appliance

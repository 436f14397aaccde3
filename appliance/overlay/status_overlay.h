#pragma once

#include <cstdint>

#include "appliance/director/status_line.h"
#include "hal/typesetter.h"

namespace appliance {

/// Adds the status line to an overlay: light letters on a soft dark plate at the picture's foot; a
/// warning is a badge, dark letters on amber. The type is 1/18 of the picture's shorter side, which
/// is readable from five metres on a screen of 65 inches. What is too long for one line is divided
/// between statements; a statement that is longer than the picture ends in an ellipsis.
///
/// RT  Not safe: allocates.
void addStatusLine(const StatusText& status, std::uint32_t width_px, std::uint32_t height_px,
                   hal::Typesetter& typesetter, hal::Overlay& overlay);

}  // namespace appliance

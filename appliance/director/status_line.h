#pragma once

#include <cstdint>

#include "appliance/director/shot.h"
#include "hal/display.h"
#include "rt/annotations.h"

namespace appliance {

/// The line over the picture, as `DELAY 3.0 s   view 7/20`, with the reason where the picture
/// is not what was asked for: `camera 7 lost: showing 8`. Views are counted from 1 here.
/// RT safe: no formatting library.
[[nodiscard]] hal::StatusLine statusLine(const Shot& shot, std::uint32_t cameras) RT_SAFE;

}  // namespace appliance

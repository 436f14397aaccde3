#pragma once

#include <string>

#include "appliance/depth/depth_loop.h"
#include "appliance/words/phrase.h"

namespace appliance {

/// "streaming: NAME, 640x480 with colour, 30.0 Hz; 900 pictures, 0 lost", in one line, and each
/// reader that took a picture.
[[nodiscard]] std::string depthText(const DepthReport& report);

/// What is less than configured; empty: nothing.
[[nodiscard]] Phrase depthTrouble(const DepthReport& report);

}  // namespace appliance

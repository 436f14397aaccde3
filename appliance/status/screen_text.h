#pragma once

#include "appliance/words/phrase.h"
#include "hal/screen_status.h"

namespace appliance {

/// Why the screen shows nothing, or less than configured, and what to do. Empty: all is well.
[[nodiscard]] Phrase screenPhrase(const hal::ScreenStatus& screen);

}  // namespace appliance

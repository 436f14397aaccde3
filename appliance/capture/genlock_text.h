#pragma once

#include <string>

#include "appliance/capture/genlock_status.h"
#include "appliance/words/phrase.h"

namespace appliance {

/// How the triggers stand to the screen, and why.
[[nodiscard]] Phrase genlockPhrase(const GenlockStatus& status, double trigger_hz);

/// The same in one line with all there is to say: what is held over, and which rates would lock.
[[nodiscard]] std::string genlockText(const GenlockStatus& status, double trigger_hz);

}  // namespace appliance

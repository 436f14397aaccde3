#pragma once

#include "appliance/director/shot.h"
#include "hal/button_panel.h"

namespace appliance {

/// The one lamp that is lit in a mode; all others are off. A sweep walks around a frozen moment;
/// slow motion shows what was some time ago.
[[nodiscard]] constexpr hal::Lamp lampOf(Mode mode) {
  switch (mode) {
    case Mode::kLive:
      return hal::Lamp::kLive;
    case Mode::kDelayed:
    case Mode::kSlow:
      return hal::Lamp::kDelayed;
    case Mode::kFrozen:
    case Mode::kSweep:
      return hal::Lamp::kFrozen;
  }
  return hal::Lamp::kLive;
}

}  // namespace appliance

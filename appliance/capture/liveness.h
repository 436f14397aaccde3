#pragma once

#include <cstdint>

#include "rt/annotations.h"

namespace appliance {

/// A camera counts as lost after so many consecutive triggers without a frame.
inline constexpr std::uint64_t kLostAfterTriggers = 3;
/// Triggers whose frames may still be on the wire: a transfer takes up to a whole period.
inline constexpr std::uint64_t kTriggersOnTheWire = 2;

/// Whether a camera whose newest stored frame is @p newest_stored delivers, given the newest
/// trigger fired.
[[nodiscard]] constexpr bool delivers(std::uint64_t newest_stored,
                                      std::uint64_t newest_fired) RT_SAFE {
  return newest_stored != 0 &&
         newest_stored + kLostAfterTriggers + kTriggersOnTheWire > newest_fired;
}

}  // namespace appliance

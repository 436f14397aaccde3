#pragma once

#include <algorithm>
#include <span>

#include "rt/clock.h"

namespace appliance {

/// The delays that the keys step through, rising; live stands below the first, the memory's end
/// above the last.
using DelayLadder = std::span<const rt::Nanoseconds>;

/// @p longest: what the memory holds.
[[nodiscard]] inline rt::Nanoseconds rungAbove(DelayLadder ladder, rt::Nanoseconds delay,
                                               rt::Nanoseconds longest) {
  const auto rung = std::ranges::upper_bound(ladder, delay);
  const rt::Nanoseconds above = rung == ladder.end() ? longest : *rung;
  return std::max(delay, std::min(above, longest));
}

[[nodiscard]] inline rt::Nanoseconds rungBelow(DelayLadder ladder, rt::Nanoseconds delay,
                                               rt::Nanoseconds longest) {
  const auto rung = std::ranges::lower_bound(ladder, std::min(delay, longest));
  return rung == ladder.begin() ? rt::Nanoseconds::zero() : *(rung - 1);
}

}  // namespace appliance

#pragma once

#include <cstdint>

#include "appliance/director/stored_views.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// What the memory offers while one picture is decided.
struct Available {
  const StoredViews& stored;
  rt::Nanoseconds period;  ///< of the trigger, above 0
  std::uint32_t cameras;
  StoredRange range;            ///< over all living cameras; over all when none lives
  std::uint64_t oldest_usable;  ///< range.oldest and the margin

  [[nodiscard]] rt::Nanoseconds inTime(std::uint64_t triggers) const RT_SAFE {
    return static_cast<std::int64_t>(triggers) * period;
  }
  [[nodiscard]] std::uint64_t inTriggers(rt::Nanoseconds time) const RT_SAFE {
    return static_cast<std::uint64_t>((time + period / 2) / period);
  }
  [[nodiscard]] rt::Nanoseconds longestDelay() const RT_SAFE {
    return inTime(range.newest - oldest_usable);
  }
  /// How long ago a moment was, counted from the newest one.
  [[nodiscard]] rt::Nanoseconds ageOf(std::uint64_t trigger) const RT_SAFE {
    return trigger < range.newest ? inTime(range.newest - trigger) : rt::Nanoseconds::zero();
  }
  [[nodiscard]] bool anyHolds(std::uint64_t trigger) const RT_SAFE;
};

/// @p margin_triggers: kept from the oldest end, whose frames may be overwritten at any time.
[[nodiscard]] Available lookAt(const StoredViews& stored, rt::Nanoseconds period,
                               std::uint32_t margin_triggers) RT_SAFE;

}  // namespace appliance

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "rt/clock.h"

namespace soak {

/// How much a program held at one instant.
struct Holding {
  rt::Timestamp at;
  std::uint64_t resident_bytes = 0;
  std::uint64_t open_files = 0;
};

/// What it holds more at the end of a run than after its warm-up; medians over kSpan each.
struct Growth {
  std::int64_t resident_bytes = 0;
  std::int64_t open_files = 0;
};

inline constexpr rt::Nanoseconds kSpan = std::chrono::seconds(10);

/// Nothing when the run did not last two spans beyond @p warm_up_end. @p held in order of time.
[[nodiscard]] std::optional<Growth> growthOf(std::span<const Holding> held,
                                             rt::Timestamp warm_up_end);

/// What the process @p pid holds now; nothing when it is gone.
[[nodiscard]] std::optional<Holding> look(int pid);

}  // namespace soak

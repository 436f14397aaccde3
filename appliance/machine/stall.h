#pragma once

#include <cstdint>
#include <optional>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// For this long one processor ran nothing of ours, not even the thread that stands above all
/// others: firmware (SMI), the host of a virtual machine, or a kernel that held it.
struct Stall {
  std::uint32_t cpu = 0;
  rt::Timestamp
      begin;          ///< the probe should have run; the processor may have stood up to 1 ms before
  rt::Timestamp end;  ///< the probe ran again

  [[nodiscard]] rt::Nanoseconds length() const RT_SAFE { return end - begin; }
};

/// What a probe that should have woken at @p due and woke at @p woke has seen: a stall when it
/// overslept by @p shortest or more.
[[nodiscard]] inline std::optional<Stall> stallOf(std::uint32_t cpu, rt::Timestamp due,
                                                  rt::Timestamp woke,
                                                  rt::Nanoseconds shortest) RT_SAFE {
  if (woke - due < shortest) return std::nullopt;
  return Stall{.cpu = cpu, .begin = due, .end = woke};
}

}  // namespace appliance

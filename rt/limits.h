#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace rt {

/// What the system lets this process do, for messages that name the number to raise.
struct Limits {
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t memlock_bytes = 0;   ///< soft RLIMIT_MEMLOCK
  std::uint64_t rt_priority = 0;     ///< soft RLIMIT_RTPRIO: the highest priority without privilege
  bool may_lock_any_amount = false;  ///< CAP_IPC_LOCK: RLIMIT_MEMLOCK does not apply
  bool may_schedule_any = false;     ///< CAP_SYS_NICE: RLIMIT_RTPRIO does not apply
};

/// RT  Not safe: reads /proc.
[[nodiscard]] Limits readLimits();

/// One line for a person, e.g. "RLIMIT_MEMLOCK 8388608 bytes, RLIMIT_RTPRIO 0".
[[nodiscard]] std::string toString(const Limits& limits);

}  // namespace rt

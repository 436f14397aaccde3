#pragma once

#include <atomic>
#include <cstdint>

#include "rt/annotations.h"
#include "rt/clock.h"
#include "rt/spsc_ring.h"

namespace rt {

/// Wakes one waiting thread: "look at your rings again".
///
/// Rings are counted, so one that comes before the wait is not lost; several
/// rings before a wait make one wake-up. The data itself crosses in a ring or a
/// latest value, written before ring().
///
/// Threads  ring(): any. waitUntil(): one thread.
/// RT       ring() adds to a counter, and makes one bounded system call (futex wake)
///          only while a thread waits; it never blocks. waitUntil() blocks.
/// Memory   What was written before ring() is visible after the waitUntil() it ends.
class Doorbell {
 public:
  Doorbell() = default;
  Doorbell(const Doorbell&) = delete;
  Doorbell& operator=(const Doorbell&) = delete;

  void ring() RT_SAFE;

  /// True as soon as it was rung since the last true; false at @p deadline.
  [[nodiscard]] bool waitUntil(Timestamp deadline) noexcept;

 private:
  [[nodiscard]] bool takeRing() noexcept;

  // Sequentially consistent on both words: either the waiter sees the new count,
  // or the ringer sees the waiter.
  alignas(kCacheLineBytes) std::atomic<std::uint32_t> rings_{0};  // the futex word
  std::atomic<std::uint32_t> waiting_{0};
  std::uint32_t seen_ = 0;  // the waiter's
};

}  // namespace rt

#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "rt/annotations.h"

namespace appliance {

/// Counts the frames of each trigger, to know when a frame set is complete. The picture never
/// waits for this; reports, calibration and the keyframes do.
///
/// Threads  arrived(): every camera's receive thread.
/// RT       Lock-free; the retry is bounded by the number of cameras.
class FrameSetBoard {
 public:
  explicit FrameSetBoard(std::uint32_t cameras) : cameras_(cameras) {}

  /// One more frame of @p trigger; true for the caller that completed the set.
  [[nodiscard]] bool arrived(std::uint64_t trigger) RT_SAFE {
    std::atomic<std::uint64_t>& entry = entries_[trigger % kCapacity];
    std::uint64_t seen = entry.load(std::memory_order_acquire);
    for (;;) {
      if (seen >> kCountBits > trigger) return false;  // so late that the entry serves another
      const bool same = seen >> kCountBits == trigger;
      const std::uint64_t next = same ? seen + 1 : (trigger << kCountBits) + 1;
      if (entry.compare_exchange_weak(seen, next, std::memory_order_acq_rel)) {
        return (next & ((1U << kCountBits) - 1)) == cameras_;
      }
    }
  }

 private:
  static constexpr std::uint64_t kCapacity = 256;
  static constexpr unsigned kCountBits = 8;
  std::uint32_t cameras_;
  std::array<std::atomic<std::uint64_t>, kCapacity> entries_{};
};

}  // namespace appliance

#pragma once

#include <atomic>
#include <cassert>
#include <cstdint>

#include "rt/annotations.h"

namespace rt {

/// How many pins one reader of a SlotPool may hold together. A reader that asks for more is
/// refused, and the refusal is counted: what one reader keeps is missing nowhere else.
///
/// Threads  Any.
/// RT       Lock-free.
/// Memory   Give a pin back after its slot was released, and spend one before a slot is pinned:
///          then a writer never meets more pinned slots than the budgets add up to.
class PinBudget {
 public:
  explicit PinBudget(std::uint32_t pins) : pins_(pins) {}

  /// False when all pins are in use.
  [[nodiscard]] bool trySpend() RT_SAFE {
    std::uint32_t used = used_.load(std::memory_order_relaxed);
    while (used < pins_) {
      if (used_.compare_exchange_weak(used, used + 1, std::memory_order_acquire,
                                      std::memory_order_relaxed)) {
        return true;
      }
    }
    refused_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }

  /// @pre a pin was spent
  void giveBack() RT_SAFE {
    [[maybe_unused]] const auto before = used_.fetch_sub(1, std::memory_order_release);
    assert(before != 0);
  }

  [[nodiscard]] std::uint32_t pins() const RT_SAFE { return pins_; }
  [[nodiscard]] std::uint32_t used() const RT_SAFE { return used_.load(std::memory_order_relaxed); }
  /// Pins that were asked for beyond the budget.
  [[nodiscard]] std::uint64_t refused() const RT_SAFE {
    return refused_.load(std::memory_order_relaxed);
  }

 private:
  const std::uint32_t pins_;
  std::atomic<std::uint32_t> used_{0};
  std::atomic<std::uint64_t> refused_{0};
};

}  // namespace rt

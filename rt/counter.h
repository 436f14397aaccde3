#pragma once

#include <atomic>
#include <cstdint>

#include "rt/annotations.h"

namespace rt {

/// How often something happened. It only ever grows.
///
/// Threads  add(), raiseTo(): one thread. value(): any.
/// RT       Wait-free: a counter with a single writer needs no read-modify-write.
class Counter {
 public:
  void add(std::uint64_t more = 1) RT_SAFE {
    value_.store(value() + more, std::memory_order_relaxed);
  }
  /// For a count that the writer keeps itself.
  void raiseTo(std::uint64_t count) RT_SAFE { value_.store(count, std::memory_order_relaxed); }

  [[nodiscard]] std::uint64_t value() const RT_SAFE {
    return value_.load(std::memory_order_relaxed);
  }

 private:
  std::atomic<std::uint64_t> value_{0};
};

}  // namespace rt

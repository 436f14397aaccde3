#pragma once

#include <cstdint>

#include "rt/clock.h"

namespace appliance {

/// How often per second something happens. Computed from its count at two polls that are at least a
/// second apart. Zero if nothing happened between them.
///
/// Threads  One.
class RateMeter {
 public:
  /// @p count: since the beginning. The first look of all gives 0.
  double hz(rt::Timestamp now, std::uint64_t count) {
    const rt::Nanoseconds passed = now - since_;
    if (since_ != rt::Timestamp{} && passed < kSpan) return hz_;
    if (since_ != rt::Timestamp{}) {
      hz_ = static_cast<double>(count - count_) * 1e9 / static_cast<double>(passed.count());
    }
    since_ = now;
    count_ = count;
    return hz_;
  }

 private:
  static constexpr rt::Nanoseconds kSpan = std::chrono::seconds(1);
  rt::Timestamp since_;  // the epoch: no look yet
  std::uint64_t count_ = 0;
  double hz_ = 0;
};

}  // namespace appliance

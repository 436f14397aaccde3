#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace rt {

/// How long something nearly always takes: the duration that all but 5 % of the last 128 did not
/// exceed. A change is known in full after 122 durations; a single slow one counts for nothing
/// once there are 20.
///
/// Threads  One.
/// RT       RT safe. high() selects among 128 numbers: microseconds, not for every packet.
class HighQuantile {
 public:
  void add(Nanoseconds duration) RT_SAFE {
    durations_[next_] = duration;
    next_ = (next_ + 1) % kKept;
    count_ = std::min(count_ + 1, kKept);
  }

  /// How many durations high() looks at.
  [[nodiscard]] std::size_t count() const RT_SAFE { return count_; }

  /// By nearest rank; zero when there is none.
  [[nodiscard]] Nanoseconds high() const RT_SAFE {
    if (count_ == 0) return {};
    std::array<Nanoseconds, kKept> sorted = durations_;
    const std::size_t rank = (count_ * kPerCent + 99) / 100;
    auto* const wanted = sorted.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(sorted.begin(), wanted, sorted.begin() + static_cast<std::ptrdiff_t>(count_));
    return *wanted;
  }

 private:
  static constexpr std::size_t kKept = 128;
  static constexpr std::size_t kPerCent = 95;
  std::array<Nanoseconds, kKept> durations_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace rt

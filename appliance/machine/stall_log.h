#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "appliance/machine/stall.h"

namespace appliance {

/// Sums up the stalls of a run for people. Overlapping stalls of several CPUs count as one, because
/// the machine stood still once.
///
/// Threads  One.
class StallLog {
 public:
  void take(const Stall& stall);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] rt::Nanoseconds longest() const { return longest_; }
  /// Whether the last one is over for less than @p span.
  [[nodiscard]] bool within(rt::Nanoseconds span, rt::Timestamp now) const {
    return last_ && now - last_->end < span;
  }
  /// "this PC stood still for 40 ms 12 s ago (firmware or host); 3 times so far, 55 ms at most";
  /// empty if it never did.
  [[nodiscard]] std::string text(rt::Timestamp now) const;

 private:
  std::optional<Stall> last_;  // with all that overlap
  std::uint64_t count_ = 0;
  rt::Nanoseconds longest_{0};
};

}  // namespace appliance

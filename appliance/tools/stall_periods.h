#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "appliance/trace/records.h"
#include "rt/clock.h"

namespace appliance {

/// When the machine stood still in a run, and which frames that may have cost. Stalls of several
/// CPUs that overlap are one. Pure.
class StallPeriods {
 public:
  /// @p period: between triggers.
  StallPeriods(std::span<const StallRecord> stalls, rt::Nanoseconds period);

  [[nodiscard]] std::size_t count() const { return stalls_.size(); }
  [[nodiscard]] rt::Nanoseconds longest() const;
  [[nodiscard]] rt::Nanoseconds total() const;

  /// Whether a stall may have cost the frame whose edge left, or whose first packet came, at @p at:
  /// from two periods before a stall, for a frame may have been on its way, until one period after
  /// it, for a camera takes no edge that follows a late one too soon.
  [[nodiscard]] bool mayHaveCost(rt::Timestamp at) const;

 private:
  struct Span {
    rt::Timestamp begin;
    rt::Timestamp end;
  };
  std::vector<Span> stalls_;  // in order, apart from each other
  rt::Nanoseconds period_;
};

}  // namespace appliance

#include "appliance/tools/stall_periods.h"

#include <algorithm>
#include <iterator>

namespace appliance {

StallPeriods::StallPeriods(std::span<const StallRecord> stalls, rt::Nanoseconds period)
    : period_(period) {
  for (const StallRecord& stall : stalls) stalls_.push_back({stall.begin, stall.end});
  std::ranges::sort(stalls_, {}, &Span::begin);
  std::size_t kept = 0;
  for (const Span& stall : stalls_) {
    if (kept > 0 && stall.begin <= stalls_[kept - 1].end) {
      stalls_[kept - 1].end = std::max(stalls_[kept - 1].end, stall.end);
    } else {
      stalls_[kept++] = stall;
    }
  }
  stalls_.resize(kept);
}

rt::Nanoseconds StallPeriods::longest() const {
  rt::Nanoseconds longest{0};
  for (const Span& stall : stalls_) longest = std::max(longest, stall.end - stall.begin);
  return longest;
}

rt::Nanoseconds StallPeriods::total() const {
  rt::Nanoseconds total{0};
  for (const Span& stall : stalls_) total += stall.end - stall.begin;
  return total;
}

bool StallPeriods::mayHaveCost(rt::Timestamp at) const {
  const auto after = std::ranges::upper_bound(stalls_, at + 2 * period_, {}, &Span::begin);
  return after != stalls_.begin() && at <= std::prev(after)->end + period_;
}

}  // namespace appliance

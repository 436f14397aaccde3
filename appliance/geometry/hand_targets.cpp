#include "appliance/geometry/hand_targets.h"

#include <algorithm>
#include <type_traits>

namespace appliance {

static_assert(std::is_trivially_copyable_v<HandTargets>, "it crosses threads by value");

void HandTargets::endAllAt(rt::Timestamp instant) {
  for (Range& range : ranges_) range.until = std::max(range.from, std::min(range.until, instant));
}

void HandTargets::set(const TargetPoint& point, rt::Timestamp from) {
  endAllAt(from);
  ranges_[count_++ % kMost] = {
      .point = point, .from = from, .until = kOpen, .revision = ++revision_};
}

void HandTargets::release(rt::Timestamp from) {
  endAllAt(from);
}

const HandTargets::Range* HandTargets::at(rt::Timestamp instant) const RT_SAFE {
  for (std::uint32_t age = 0; age < std::min(count_, kMost); ++age) {
    const Range& range = newest(age);
    if (range.from <= instant && instant < range.until) return &range;
  }
  return nullptr;
}

const HandTargets::Range* HandTargets::open() const RT_SAFE {
  return count_ > 0 && newest(0).until == kOpen ? &newest(0) : nullptr;
}

}  // namespace appliance

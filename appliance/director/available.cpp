#include "appliance/director/available.h"

#include <algorithm>

namespace appliance {

bool Available::anyHolds(std::uint64_t trigger) const RT_SAFE {
  for (std::uint32_t camera = 0; camera < cameras; ++camera)
    if (stored.holds(camera, trigger)) return true;
  return false;
}

Available lookAt(const StoredViews& stored, rt::Nanoseconds period,
                 std::uint32_t margin_triggers) RT_SAFE {
  const auto cameras = std::min<std::uint32_t>(stored.cameras(), kMostViews);
  StoredRange of_living;
  StoredRange of_all;
  const auto widen = [](StoredRange& sum, const StoredRange& range) {
    sum.oldest = sum.empty() ? range.oldest : std::min(sum.oldest, range.oldest);
    sum.newest = std::max(sum.newest, range.newest);
  };
  for (std::uint32_t camera = 0; camera < cameras; ++camera) {
    const StoredRange range = stored.range(camera);
    if (range.empty()) continue;
    widen(of_all, range);
    if (stored.living(camera)) widen(of_living, range);
  }
  const StoredRange range = of_living.empty() ? of_all : of_living;
  return {.stored = stored,
          .period = std::max(period, rt::Nanoseconds(1)),
          .cameras = cameras,
          .range = range,
          .oldest_usable = std::min(range.oldest + margin_triggers, range.newest)};
}

}  // namespace appliance

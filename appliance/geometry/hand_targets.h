#pragma once

#include <array>
#include <cstdint>

#include "appliance/geometry/target_point.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// The points that people set. Each holds for a range of instants: from the moment that was on
/// screen when it was given until the next point is set, or until it is released. Ranges never
/// overlap. Pure and trivially copyable.
class HandTargets {
 public:
  struct Range {
    TargetPoint point;
    rt::Timestamp from;
    rt::Timestamp until;  ///< kOpen: not released yet
    std::uint64_t revision = 0;
  };

  /// The oldest ranges are forgotten when people set more points than this.
  static constexpr std::uint32_t kMost = 8;
  static constexpr rt::Timestamp kOpen = rt::Timestamp::max();

  /// @p point holds from @p from on; what held there before ends.
  void set(const TargetPoint& point, rt::Timestamp from);
  /// From @p from on no set point holds.
  void release(rt::Timestamp from);

  /// The point that a person set for @p instant; null: none.
  [[nodiscard]] const Range* at(rt::Timestamp instant) const RT_SAFE;
  /// The point that holds until further notice; null: none.
  [[nodiscard]] const Range* open() const RT_SAFE;

 private:
  void endAllAt(rt::Timestamp instant);
  [[nodiscard]] const Range& newest(std::uint32_t age) const RT_SAFE {
    return ranges_[(count_ - 1 - age) % kMost];
  }

  std::array<Range, kMost> ranges_{};
  std::uint32_t count_ = 0;  // ever set
  std::uint64_t revision_ = 0;
};

}  // namespace appliance

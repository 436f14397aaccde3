#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "appliance/director/stored_views.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// Which views deliver without interruption. A view that failed is steady again once it has
/// delivered for kProven, so that a camera that comes and goes does not make the picture jump to
/// and fro. The first time counts immediately: a box that starts shows what it has.
///
/// Threads  One. Pure: time is an argument.
/// RT       RT safe.
class SteadyViews {
 public:
  static constexpr rt::Nanoseconds kProven = std::chrono::seconds(1);

  /// Another stretch of time is played: forget what was learnt of the last one.
  void reset() RT_SAFE { views_ = {}; }

  /// Once for each view and picture.
  void note(std::uint32_t view, bool delivers, rt::Timestamp now) RT_SAFE {
    View& of = views_[view % kMostViews];
    if (delivers && !of.delivers) of.steady_from = of.failed_after_delivering ? now + kProven : now;
    if (!delivers && of.delivers) of.failed_after_delivering = true;
    of.delivers = delivers;
    of.steady = delivers && now >= of.steady_from;
  }

  [[nodiscard]] bool steady(std::uint32_t view) const RT_SAFE {
    return views_[view % kMostViews].steady;
  }

 private:
  struct View {
    bool delivers = false;
    bool failed_after_delivering = false;
    bool steady = false;
    rt::Timestamp steady_from;
  };
  std::array<View, kMostViews> views_{};
};

}  // namespace appliance

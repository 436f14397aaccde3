#pragma once

#include <Eigen/Core>

#include "rt/annotations.h"
#include "rt/clock.h"
#include "rt/latest_value.h"

namespace appliance {

/// Where the athlete was at an instant, rig frame. Trivially copyable.
struct TargetPoint {
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;

  friend bool operator==(const TargetPoint&, const TargetPoint&) = default;

  [[nodiscard]] Eigen::Vector3d vector() const { return {x_m, y_m, z_m}; }
};

/// The target point over time. A point that was set holds for every instant, past ones too:
/// without a tracker the whole history is looked at where the coach says now.
///
/// Threads  set(): one writer (control). at(): one reader (the render thread).
/// RT       Both RT safe.
class TargetTrack {
 public:
  explicit TargetTrack(const TargetPoint& initial) : point_(initial) {}

  void set(const TargetPoint& point) RT_SAFE { point_.publish(point); }

  [[nodiscard]] TargetPoint at(rt::Timestamp /*exposure*/) RT_SAFE { return point_.latest(); }

 private:
  rt::LatestValue<TargetPoint> point_;
};

}  // namespace appliance

#include "hal/openni/clock_fit.h"

#include <algorithm>
#include <cmath>

namespace hal::openni {
namespace {

constexpr double kBucket_ns = 1e9;
constexpr std::size_t kBuckets = 60;
constexpr double kFewest_ns = 10e9;   // of time, before a slope means anything
constexpr double kJump_ns = 1e9;      // no delay: another clock
constexpr double kSteepest = 500e-6;  // no crystal is worse

}  // namespace

void ClockFit::restart(std::uint64_t stamp_us, rt::Timestamp arrival) {
  points_.clear();
  first_stamp_us_ = stamp_us;
  first_arrival_ = arrival;
  slope_ = 0;
  offset_ = 0;
}

void ClockFit::add(std::uint64_t stamp_us, rt::Timestamp arrival) {
  if (points_.empty() || stamp_us < last_stamp_us_) restart(stamp_us, arrival);
  Point point{static_cast<double>(stamp_us - first_stamp_us_) * 1e3, 0};
  point.behind = static_cast<double>((arrival - first_arrival_).count()) - point.stamp;
  if (std::abs(point.behind - (offset_ + slope_ * point.stamp)) > kJump_ns) {
    restart(stamp_us, arrival);
    point = {0, 0};
  }
  last_stamp_us_ = stamp_us;
  // Buckets are aligned, so which picture stands for a second does not depend on the others.
  const bool same_bucket = !points_.empty() && std::floor(points_.back().stamp / kBucket_ns) ==
                                                   std::floor(point.stamp / kBucket_ns);
  if (!same_bucket) {
    points_.push_back(point);
    if (points_.size() > kBuckets) points_.pop_front();
  } else if (point.behind < points_.back().behind) {
    points_.back() = point;
  } else {
    return;
  }
  fit();
}

void ClockFit::fit() {
  hull_.clear();
  for (const Point& point : points_) {
    const auto above = [&](const Point& a, const Point& b) {  // b, seen from a to point
      return (b.behind - a.behind) * (point.stamp - a.stamp) >=
             (point.behind - a.behind) * (b.stamp - a.stamp);
    };
    while (hull_.size() >= 2 && above(hull_[hull_.size() - 2], hull_.back())) hull_.pop_back();
    hull_.push_back(point);
  }
  const double from = points_.front().stamp;
  const double to = points_.back().stamp;
  if (to - from < kFewest_ns) {
    slope_ = 0;
    offset_ = std::ranges::min(points_, {}, &Point::behind).behind;
    return;
  }
  const auto after = std::ranges::upper_bound(hull_, (from + to) / 2, {}, &Point::stamp);
  const Point& left = *(after - 1);
  const Point& right = *after;
  slope_ =
      std::clamp((right.behind - left.behind) / (right.stamp - left.stamp), -kSteepest, kSteepest);
  offset_ = left.behind - slope_ * left.stamp;
}

rt::Timestamp ClockFit::earliestArrival(std::uint64_t stamp_us) const {
  const double stamp = (static_cast<double>(stamp_us) - static_cast<double>(first_stamp_us_)) * 1e3;
  return first_arrival_ + rt::Nanoseconds(std::llround(stamp + offset_ + slope_ * stamp));
}

}  // namespace hal::openni

#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "rt/clock.h"

namespace hal::openni {

/// Finds from stamps and arrivals how a sensor's clock runs against ours.
///
/// What delays an arrival is never negative, so the truth lies along the lower edge of the points
/// (stamp, arrival - stamp): the edge of their lower convex hull under the middle of the last
/// minute (Zhang, Liu and Xia, Clock synchronization algorithms for network measurements, 2002).
/// Until there are ten seconds of them both clocks are taken to run alike.
///
/// Threads  One caller.
/// Units    Stamps are microseconds of the sensor's clock, as OpenNI2 gives them.
class ClockFit {
 public:
  /// A stamp that runs backwards, or away from ours, starts the fit again: the sensor restarted.
  void add(std::uint64_t stamp_us, rt::Timestamp arrival);

  /// When a picture of that stamp arrives if nothing holds it up. Needs one add() before.
  [[nodiscard]] rt::Timestamp earliestArrival(std::uint64_t stamp_us) const;

  /// How much faster than ours the sensor's clock runs.
  [[nodiscard]] double drift_ppm() const { return -slope_ * 1e6; }

 private:
  /// The most punctual picture of about a second; nanoseconds since the first.
  struct Point {
    double stamp;
    double behind;  // arrival less stamp
  };

  void restart(std::uint64_t stamp_us, rt::Timestamp arrival);
  void fit();

  std::deque<Point> points_;
  std::vector<Point> hull_;
  std::uint64_t first_stamp_us_ = 0;
  std::uint64_t last_stamp_us_ = 0;
  rt::Timestamp first_arrival_;
  double slope_ = 0;
  double offset_ = 0;  // of the line behind = offset + slope * stamp
};

}  // namespace hal::openni

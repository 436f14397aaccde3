#include "appliance/director/move.h"

#include <algorithm>
#include <cmath>

namespace appliance {
namespace {

/// One degree in an hour and a half. A slower move could not be seen, and its duration could
/// overflow.
constexpr double kSlowest_deg_per_s = 2e-4;

double easeOf(const Move& move) {
  return std::clamp(move.ease, 0.0, 0.5);
}

/// The time of the whole way: the eased ends go at half the speed on average.
double duration_s(const Move& move) {
  if (!(move.speed_deg_per_s > 0)) return 0;
  const double speed_deg_per_s = std::max(move.speed_deg_per_s, kSlowest_deg_per_s);
  return std::abs(move.to_deg - move.from_deg) / speed_deg_per_s * (1 + 2 * easeOf(move));
}

/// The share of the way after the share @p time of the duration, for the first half of an even
/// or eased way.
double firstHalf(double time, double ease) {
  const double whole = 1 + 2 * ease;  // duration in units of the way at full speed
  const double speeding = 2 * ease;   // of which this long is spent on speeding up
  const double passed = time * whole;
  if (passed >= speeding) return passed - ease;
  return passed * passed / (2 * speeding);
}

}  // namespace

rt::Timestamp Move::arrival() const RT_SAFE {
  return begin + rt::Nanoseconds(std::llround(duration_s(*this) * 1e9));
}

double Move::angle(rt::Timestamp t) const RT_SAFE {
  if (t >= arrival()) return to_deg;
  if (t <= begin) return from_deg;
  const double time = static_cast<double>((t - begin).count()) * 1e-9 / duration_s(*this);
  const double ease_ = easeOf(*this);
  const double way = time < 0.5 ? firstHalf(time, ease_) : 1 - firstHalf(1 - time, ease_);
  return from_deg + (to_deg - from_deg) * std::clamp(way, 0.0, 1.0);
}

}  // namespace appliance

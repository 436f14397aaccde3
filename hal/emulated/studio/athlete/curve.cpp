#include "hal/emulated/studio/athlete/curve.h"

#include <algorithm>
#include <cmath>

namespace emulator::studio {
namespace {

constexpr double kShortest_s = 1e-3;

}  // namespace

void Curve::key(double t, double value) {
  while (!keys_.empty() && keys_.back().t >= t - kShortest_s) keys_.pop_back();
  keys_.push_back({t, value});
}

double Curve::slope(std::size_t i) const {
  if (i == 0 || i + 1 >= keys_.size()) return 0;
  const double before = keys_[i].t - keys_[i - 1].t;
  const double after = keys_[i + 1].t - keys_[i].t;
  const double rise_before = (keys_[i].value - keys_[i - 1].value) / before;
  const double rise_after = (keys_[i + 1].value - keys_[i].value) / after;
  if (rise_before * rise_after <= 0) return 0;  // a turning point
  const double w1 = 2 * after + before;
  const double w2 = after + 2 * before;
  const double mean = (w1 + w2) / (w1 / rise_before + w2 / rise_after);
  // A quintic without acceleration at its ends is monotonic up to twice the mean slope.
  const double steepest = 2 * std::min(std::abs(rise_before), std::abs(rise_after));
  return std::clamp(mean, -steepest, steepest);
}

double Curve::at(double t) const {
  if (keys_.empty()) return rest_;
  if (t <= keys_.front().t) return keys_.front().value;
  if (t >= keys_.back().t) return keys_.back().value;
  const auto next = std::ranges::upper_bound(keys_, t, {}, &Key::t);
  const auto i = static_cast<std::size_t>(next - keys_.begin()) - 1;
  const double span = keys_[i + 1].t - keys_[i].t;
  const double x = (t - keys_[i].t) / span;
  const double a = keys_[i].value;
  const double d = keys_[i + 1].value - a;
  const double v0 = slope(i) * span;
  const double v1 = slope(i + 1) * span;
  const double x3 = x * x * x;
  return a + v0 * x +
         x3 * ((10 * d - 6 * v0 - 4 * v1) +
               x * ((-15 * d + 8 * v0 + 7 * v1) + x * (6 * d - 3 * v0 - 3 * v1)));
}

}  // namespace emulator::studio

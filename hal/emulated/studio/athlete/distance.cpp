#include "hal/emulated/studio/athlete/distance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace emulator::studio {
namespace {

float catmullRom(float a, float b, float c, float d, float x) {
  return b + 0.5F * x * (c - a + x * (2 * a - 5 * b + 4 * c - d + x * (3 * (b - c) + d - a)));
}

}  // namespace

float smoothUnion(float a, float b, float blend) {
  const float h = std::max(blend - std::abs(a - b), 0.0F) / blend;
  return std::min(a, b) - h * h * h * blend * (1.0F / 6.0F);
}

float smoothMeet(float a, float b, float blend) {
  return -smoothUnion(-a, -b, blend);
}

float ellipsoid(const Point& p, const Point& centre, const Point& radii) {
  const Point q = (p - centre).cwiseQuotient(radii);
  const float k0 = q.norm();
  const float k1 = q.cwiseQuotient(radii).norm();
  return k1 > 1e-6F ? k0 * (k0 - 1) / k1 : -radii.minCoeff();
}

float capsule(const Point& p, const Point& a, const Point& b, float radius_a, float radius_b) {
  const Point ab = b - a;
  const float h = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0F, 1.0F);
  return (p - a - ab * h).norm() - (radius_a + (radius_b - radius_a) * h);
}

Loft::Loft(const Point& a, const Point& b, const Point& front, float cap,
           std::span<const Section> sections)
    : a_(a), axis_((b - a).normalized()), length_((b - a).norm()), cap_(cap) {
  front_ = (front - axis_ * front.dot(axis_)).normalized();
  side_ = front_.cross(axis_);
  const auto last = static_cast<int>(sections.size()) - 1;
  const auto at = [&](int i) -> const Section& {
    return sections[static_cast<std::size_t>(std::clamp(i, 0, last))];
  };
  int i = 0;
  for (int row = 0; row <= kRows; ++row) {
    const float t = static_cast<float>(row) / kRows;
    while (i + 1 < last && t > at(i + 1).t) ++i;
    const float x = std::clamp((t - at(i).t) / (at(i + 1).t - at(i).t), 0.0F, 1.0F);
    const auto mix = [&](float Section::* member) {
      return catmullRom(at(i - 1).*member, at(i).*member, at(i + 1).*member, at(i + 2).*member, x);
    };
    rows_[static_cast<std::size_t>(row)] = {mix(&Section::side), mix(&Section::front),
                                            mix(&Section::back), mix(&Section::shift)};
  }
  rows_[kRows + 1] = rows_[kRows];
  for (const auto& row : rows_) {
    reach_ = std::max(
        {reach_, row.side, row.front + std::abs(row.shift), row.back + std::abs(row.shift)});
  }
}

float Loft::distance(const Point& p) const {
  const Point q = p - a_;
  const float z = q.dot(axis_);
  const float excess = std::max(-z, z - length_);
  const float s = q.dot(side_);
  const float f_axis = q.dot(front_);
  const float far = std::sqrt(s * s + f_axis * f_axis) - reach_;
  if (far > 0.10F)
    return std::hypot(far, std::max(excess, 0.0F));  // far away a cylinder is close enough

  const float x = std::clamp(z / length_, 0.0F, 1.0F) * kRows;
  const auto i = static_cast<std::size_t>(x);
  const float part = x - static_cast<float>(i);
  const Row& low = rows_[i];
  const Row& high = rows_[i + 1];
  const auto mix = [part](float a, float b) { return a + (b - a) * part; };
  const float f = f_axis - mix(low.shift, high.shift);
  const float rs = mix(low.side, high.side);
  const float rf = f > 0 ? mix(low.front, high.front) : mix(low.back, high.back);
  const float qs = s / rs;
  const float qf = f / rf;
  const float k0 = std::sqrt(qs * qs + qf * qf);
  const float k1 = std::sqrt(qs * qs / (rs * rs) + qf * qf / (rf * rf));
  const float across = k1 > 1e-6F ? k0 * (k0 - 1) / k1 : -std::min(rs, rf);
  // A rounded box of (across, along): flat ends `cap_` beyond the axis, with a round rim.
  const float dx = across + cap_;
  const float out = std::hypot(std::max(dx, 0.0F), std::max(excess, 0.0F));
  return std::min(std::max(dx, excess), 0.0F) + out - cap_;
}

}  // namespace emulator::studio

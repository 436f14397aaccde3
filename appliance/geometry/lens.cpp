#include "appliance/geometry/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace appliance {
namespace {

constexpr int kDirections = 64;
constexpr double kCornerMargin = 1.05;
constexpr double kWidestRadius = 20;  // 87 degrees off the axis

Point2 distorted(const std::array<double, 5>& distortion, Point2 p) {
  const auto [k1, k2, p1, p2, k3] = distortion;
  const auto [x, y] = p;
  const double s = x * x + y * y;
  const double radial = 1 + s * (k1 + s * (k2 + s * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (s + 2 * x * x),
          y * radial + p1 * (s + 2 * y * y) + 2 * p2 * x * y};
}

/// Neither the distorted radius nor the orientation of the mapping has turned at @p p.
bool isMonotonic(const std::array<double, 5>& distortion, Point2 p) {
  const auto [k1, k2, p1, p2, k3] = distortion;
  const auto [x, y] = p;
  const double s = x * x + y * y;
  const double radial = 1 + s * (k1 + s * (k2 + s * k3));
  const double slope = 2 * (k1 + s * (2 * k2 + s * 3 * k3));  // of radial, over x dx + y dy
  const double dx_dx = radial + x * x * slope + 2 * p1 * y + 6 * p2 * x;
  const double dy_dy = radial + y * y * slope + 6 * p1 * y + 2 * p2 * x;
  const double dx_dy = x * y * slope + 2 * p1 * x + 2 * p2 * y;  // and dy_dx, the same
  const double radius_slope = radial + s * slope;
  return dx_dx * dy_dy - dx_dy * dx_dy > 0 && radius_slope > 0 && radial > 0;
}

Point2 onCircle(double radius, int direction) {
  const double angle = 2 * std::numbers::pi * direction / kDirections;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

bool isMonotonicAround(const std::array<double, 5>& distortion, double radius) {
  for (int direction = 0; direction < kDirections; ++direction) {
    if (!isMonotonic(distortion, onCircle(radius, direction))) return false;
  }
  return true;
}

/// Every point of the circle lies outside the picture, whose corner is at @p corner.
bool leavesPicture(const std::array<double, 5>& distortion, double radius, double corner) {
  for (int direction = 0; direction < kDirections; ++direction) {
    const auto [x, y] = distorted(distortion, onCircle(radius, direction));
    if (std::hypot(x, y) < corner) return false;
  }
  return true;
}

}  // namespace

Point2 distortedPixel(const hal::Lens& lens, Point2 undistorted) RT_SAFE {
  const auto [x, y] = distorted(lens.distortion, undistorted);
  return {lens.fx_px * x + lens.cx_px, lens.fy_px * y + lens.cy_px};
}

double maxRadius(const hal::Lens& lens, std::uint32_t width_px, std::uint32_t height_px) {
  const double far_x = std::max(lens.cx_px, width_px - 1 - lens.cx_px) / lens.fx_px;
  const double far_y = std::max(lens.cy_px, height_px - 1 - lens.cy_px) / lens.fy_px;
  const double corner = kCornerMargin * std::hypot(far_x, far_y);
  const double widest = std::min(kWidestRadius, 16 * corner);
  const double step = std::min(corner / 256, 0.01);
  if (!(step > 0)) return 0;

  double good = 0;
  while (good < widest && !leavesPicture(lens.distortion, good, corner)) {
    double next = good + step;
    if (!isMonotonicAround(lens.distortion, next)) {
      for (int halving = 0; halving < 20; ++halving) {
        const double middle = (good + next) / 2;
        (isMonotonicAround(lens.distortion, middle) ? good : next) = middle;
      }
      return good;
    }
    good = next;
  }
  return good;
}

}  // namespace appliance

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <rapidcheck/gtest.h>

#include "appliance/geometry/lens.h"
#include "tests/property/random_rig.h"

namespace {

using appliance::distortedPixel;
using appliance::maxRadius;
using appliance::Point2;
using geometry_test::between;

constexpr std::uint32_t kWidth_px = 1280;
constexpr std::uint32_t kHeight_px = 1024;

/// Anything from a good lens to a model that no lens has.
hal::Lens anyLens() {
  hal::Lens lens{.fx_px = between(300, 3000), .fy_px = 0, .cx_px = 639.5, .cy_px = 511.5};
  lens.fy_px = lens.fx_px * between(0.95, 1.05);
  lens.distortion = {between(-1, 1), between(-1, 1), between(-0.02, 0.02), between(-0.02, 0.02),
                     between(-1, 1)};
  return lens;
}

Point2 atAngle(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Distance of the distorted point from the axis, in focal lengths, of the radial part alone.
double radialPart(const hal::Lens& lens, double r) {
  const auto [k1, k2, p1, p2, k3] = lens.distortion;
  return r * (1 + r * r * (k1 + r * r * (k2 + r * r * k3)));
}

RC_GTEST_PROP(Lens, DistortsAsOpenCvDoes, ()) {
  const hal::Lens lens = anyLens();
  const double x = between(-1, 1);
  const double y = between(-1, 1);
  std::vector<cv::Point2d> expected;
  const cv::Matx33d A(lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1);
  cv::projectPoints(std::vector<cv::Point3d>{{x, y, 1}}, cv::Vec3d(), cv::Vec3d(), A,
                    std::vector<double>(lens.distortion.begin(), lens.distortion.end()), expected);
  const Point2 pixel = distortedPixel(lens, {x, y});
  RC_ASSERT(std::hypot(pixel[0] - expected[0].x, pixel[1] - expected[0].y) < 1e-6);
}

RC_GTEST_PROP(Lens, IsMonotonicUpToItsMaximumRadius, ()) {
  const hal::Lens lens = anyLens();
  const double limit = maxRadius(lens, kWidth_px, kHeight_px);
  RC_ASSERT(limit > 0);
  double last = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double distorted = radialPart(lens, limit * i / 1000);
    RC_ASSERT(distorted > last);
    last = distorted;
  }
}

/// Two points of the used disc never share a source pixel: the numeric Jacobian keeps its sign.
RC_GTEST_PROP(Lens, NeverFoldsThePictureWithinItsMaximumRadius, ()) {
  const hal::Lens lens = anyLens();
  const double r = between(0, 0.999) * maxRadius(lens, kWidth_px, kHeight_px);
  const Point2 p = atAngle(r, between(0, 2 * std::numbers::pi));
  constexpr double kStep = 1e-6;
  const Point2 right = distortedPixel(lens, {p[0] + kStep, p[1]});
  const Point2 left = distortedPixel(lens, {p[0] - kStep, p[1]});
  const Point2 below = distortedPixel(lens, {p[0], p[1] + kStep});
  const Point2 above = distortedPixel(lens, {p[0], p[1] - kStep});
  RC_ASSERT((right[0] - left[0]) * (below[1] - above[1]) -
                (right[1] - left[1]) * (below[0] - above[0]) >
            0);
}

RC_GTEST_PROP(Lens, CoversTheWholePictureUnlessTheModelFoldsFirst, ()) {
  const hal::Lens lens = anyLens();
  const double limit = maxRadius(lens, kWidth_px, kHeight_px);
  const double corner = std::hypot(640 / lens.fx_px, 512 / lens.fy_px);
  bool covers = true;
  for (int i = 0; i < 64; ++i) {
    const Point2 pixel = distortedPixel(lens, atAngle(limit, i * std::numbers::pi / 32));
    covers = covers && std::hypot((pixel[0] - lens.cx_px) / lens.fx_px,
                                  (pixel[1] - lens.cy_px) / lens.fy_px) >= corner;
  }
  if (covers) return;
  // Then a little further out something turns over, in at least one direction.
  bool folds = false;
  for (int i = 0; i < 256 && !folds; ++i) {
    const double angle = i * std::numbers::pi / 128;
    for (const double further : {1.002, 1.01}) {
      const Point2 inner = distortedPixel(lens, atAngle(limit * (further - 0.001), angle));
      const Point2 outer = distortedPixel(lens, atAngle(limit * further, angle));
      const Point2 beside = distortedPixel(lens, atAngle(limit * further, angle + 0.001));
      const double turned = (outer[0] - inner[0]) * (beside[1] - outer[1]) -
                            (outer[1] - inner[1]) * (beside[0] - outer[0]);
      folds = folds || turned <= 0 ||
              radialPart(lens, limit * further) <= radialPart(lens, limit * (further - 0.001));
    }
  }
  RC_ASSERT(folds);
}

}  // namespace

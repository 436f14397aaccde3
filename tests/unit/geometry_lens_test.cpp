#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "appliance/geometry/lens.h"

namespace {

using appliance::maxRadius;

hal::Lens lensWith(std::array<double, 5> distortion, double focal_px = 1000) {
  return {.fx_px = focal_px,
          .fy_px = focal_px,
          .cx_px = 639.5,
          .cy_px = 511.5,
          .distortion = distortion};
}

TEST(MaxRadius, OfAPinholeIsTheCornerAndATwentieth) {
  const double corner = std::hypot(0.6395, 0.5115);
  EXPECT_NEAR(maxRadius(lensWith({}), 1280, 1024), 1.05 * corner, corner / 200);
}

TEST(MaxRadius, OfABarrelIsWhereTheDistortedRadiusTurns) {
  // d/dr (r + k1 r^3) = 0 at r = sqrt(-1 / 3 k1).
  EXPECT_NEAR(maxRadius(lensWith({-0.5, 0, 0, 0, 0}, 600), 1280, 1024), std::sqrt(1 / 1.5), 1e-5);
}

TEST(MaxRadius, OfAGentleBarrelReachesBeyondTheCornersOfItsUndistortedPicture) {
  // The corner's undistorted radius solves r (1 - 0.1 r^2) = 0.8188.
  const double limit = maxRadius(lensWith({-0.1, 0, 0, 0, 0}), 1280, 1024);
  EXPECT_GT(limit, 0.885);
  EXPECT_LT(limit, 1.0);
}

TEST(MaxRadius, IsNothingForNumbersThatAreNoLens) {
  constexpr double kHuge = std::numeric_limits<double>::max();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(maxRadius(lensWith({-kHuge, 0, 0, 0, 0}), 1280, 1024), 1e-2);
  EXPECT_EQ(maxRadius(lensWith({kNan, 0, 0, 0, 0}), 1280, 1024), 0);
  EXPECT_EQ(maxRadius(lensWith({}, kNan), 1280, 1024), 0);
}

}  // namespace

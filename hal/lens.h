#pragma once

#include <array>

namespace hal {

/// Pinhole and Brown-Conrady distortion in OpenCV's convention (k1, k2, p1, p2, k3).
struct Lens {
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  std::array<double, 5> distortion{};
  /// Undistorted radius (in units of the focal length) up to which the distortion
  /// model is monotonic; beyond it there is border, never a folded picture.
  double max_radius = 0;
};

}  // namespace hal

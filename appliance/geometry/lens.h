#pragma once

#include <array>
#include <cstdint>

#include "hal/lens.h"
#include "rt/annotations.h"

namespace appliance {

/// A point on the plane one focal length before the camera (z = 1), or its image in pixels.
using Point2 = std::array<double, 2>;

/// Undistorted plane point -> distorted source pixel, Brown-Conrady as OpenCV has it
/// (k1 k2 p1 p2 k3). RT safe.
[[nodiscard]] Point2 distortedPixel(const hal::Lens& lens, Point2 undistorted) RT_SAFE;

/// The undistorted radius up to which @p lens is used, in focal lengths: the smaller of what
/// the picture's corners need (and a twentieth more), and where the model folds, that is
/// where the distorted radius no longer grows with the undistorted one or the mapping
/// turns over. Beyond it a source pixel would be drawn twice.
///
/// RT      Not RT safe: thousands of evaluations, once per camera at start.
/// Errors  0 for a model that folds at its centre or is not finite.
[[nodiscard]] double maxRadius(const hal::Lens& lens, std::uint32_t width_px,
                               std::uint32_t height_px);

}  // namespace appliance

#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "appliance/geometry/rig.h"
#include "rt/annotations.h"

namespace appliance {

/// A homography between pixels, row-major, pixel centres at integers.
using Homography = std::array<double, 9>;

/// What the output picture shall be, the same for all views.
struct ViewParameters {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  /// About the output's centre. At 1 the height of a source picture fills the height of the
  /// output: k = height_px / Rig::reference_height_px.
  double zoom = 1;
};

/// How one camera's picture becomes the constant view of a target point.
struct View {
  Homography H_display_camera{};  ///< undistorted camera pixel -> display pixel
  Homography H_camera_display{};  ///< its inverse, which the renderer samples by
  bool valid = false;             ///< false: all zero, nothing can be shown
};

/// The constant view of @p target_m by one camera: H_m = S A'_m R'_m R_m^-1 A_m^-1 of
/// docs/architecture.md, "Mathematics of the constant view", with f'_m = f_ref d_m / d_ref.
///
/// Not valid when the target is nearer than kNearestTarget_m, beyond kFarthestTarget_m or
/// more than about 87 degrees off the camera's axis (behind it included), and when an
/// input is not finite. A camera that looks at the target straight up or down has no rig-up in its
/// picture: then the camera's own up is kept.
///
/// RT      RT safe; about 0.1 us (tests/bench/homographies_bench.cpp).
/// Errors  Never NaN or infinite, for any input.
[[nodiscard]] View viewOf(const RigCamera& camera, const Rig& rig, const Eigen::Vector3d& target_m,
                          const ViewParameters& parameters) RT_SAFE;

/// All views of a rig: views[m] of rig.cameras[m]. @p views is at least as long as the cameras.
/// RT safe.
void computeViews(const Rig& rig, const Eigen::Vector3d& target_m, const ViewParameters& parameters,
                  std::span<View> views) RT_SAFE;

inline constexpr double kNearestTarget_m = 0.1;
inline constexpr double kFarthestTarget_m = 10'000;
inline constexpr double kSmallestAxisCosine = 0.05;

}  // namespace appliance

#include "appliance/geometry/homography.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>

namespace appliance {
namespace {

constexpr double kLargestZoom = 1000;
/// Sine of the angle to the vertical below which "up" no longer orients the picture.
constexpr double kStraightUpSine = 1e-3;

/// Rows e_x, e_y, e_z of R'_m for the line of sight @p e_z.
Eigen::Matrix3d levelRotation(const Eigen::Vector3d& e_z, const Eigen::Vector3d& camera_up) {
  Eigen::Vector3d e_x = e_z.cross(Eigen::Vector3d::UnitZ());
  if (e_x.norm() < kStraightUpSine) e_x = e_z.cross(camera_up);
  e_x.normalize();
  Eigen::Matrix3d R;
  R.row(0) = e_x;
  R.row(1) = e_z.cross(e_x);
  R.row(2) = e_z;
  return R;
}

bool allFinite(const Homography& H) {
  return std::ranges::all_of(H, [](double element) { return std::isfinite(element); });
}

Homography rowMajor(const Eigen::Matrix3d& H) {
  Homography out{};
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(out.data()) = H;
  return out;
}

}  // namespace

View viewOf(const RigCamera& camera, const Rig& rig, const Eigen::Vector3d& target_m,
            const ViewParameters& parameters) RT_SAFE {
  const Eigen::Matrix3d& R = camera.R_cam_rig;
  const Eigen::Vector3d target_cam_m = R * target_m + camera.t_cam_rig_m;
  const double distance_m = target_cam_m.norm();
  // Written so that a NaN refuses too.
  if (!(distance_m >= kNearestTarget_m && distance_m <= kFarthestTarget_m)) return {};
  if (!(target_cam_m.z() > kSmallestAxisCosine * distance_m)) return {};
  if (!(parameters.zoom > 1 / kLargestZoom && parameters.zoom < kLargestZoom)) return {};
  if (parameters.width_px == 0 || parameters.height_px == 0) return {};

  const Eigen::Vector3d e_z = R.transpose() * target_cam_m / distance_m;
  const Eigen::Matrix3d R_view_rig = levelRotation(e_z, -R.row(1).transpose());
  const Eigen::Matrix3d R_view_cam = R_view_rig * R.transpose();

  const double k = parameters.height_px / rig.reference_height_px;
  // Grows with the distance: the picture of a length shrinks by exactly that.
  const double f_view_px = rig.reference_focal_px * distance_m / rig.reference_distance_m;
  const double f = parameters.zoom * k * f_view_px;
  const double u0 = (parameters.width_px - 1.0) / 2;
  const double v0 = (parameters.height_px - 1.0) / 2;
  const hal::Lens& lens = camera.lens;

  Eigen::Matrix3d A_view;
  A_view << f, 0, u0, 0, f, v0, 0, 0, 1;
  Eigen::Matrix3d A_view_inverse;
  A_view_inverse << 1 / f, 0, -u0 / f, 0, 1 / f, -v0 / f, 0, 0, 1;
  Eigen::Matrix3d A;
  A << lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1;
  Eigen::Matrix3d A_inverse;
  A_inverse << 1 / lens.fx_px, 0, -lens.cx_px / lens.fx_px,  //
      0, 1 / lens.fy_px, -lens.cy_px / lens.fy_px, 0, 0, 1;

  View view;
  view.H_display_camera = rowMajor(A_view * R_view_cam * A_inverse);
  view.H_camera_display = rowMajor(A * R_view_cam.transpose() * A_view_inverse);
  view.valid = allFinite(view.H_display_camera) && allFinite(view.H_camera_display);
  return view.valid ? view : View{};
}

void computeViews(const Rig& rig, const Eigen::Vector3d& target_m, const ViewParameters& parameters,
                  std::span<View> views) RT_SAFE {
  assert(views.size() >= rig.cameras.size());
  std::size_t m = 0;
  for (const RigCamera& camera : rig.cameras) {
    views[m++] = viewOf(camera, rig, target_m, parameters);
  }
}

}  // namespace appliance

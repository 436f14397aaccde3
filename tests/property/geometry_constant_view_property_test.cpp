#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <rapidcheck/gtest.h>

#include "appliance/geometry/homography.h"
#include "tests/property/random_rig.h"

namespace {

using appliance::Homography;
using appliance::RigCamera;
using appliance::View;
using appliance::viewOf;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry_test::anyIn;
using geometry_test::between;
using geometry_test::pointWithin;
using geometry_test::randomScene;
using geometry_test::Scene;
using property_test::anyBits;

Matrix3d matrix(const Homography& H) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(H.data());
}

Matrix3d intrinsics(const RigCamera& camera) {
  Matrix3d A;
  A << camera.lens.fx_px, 0, camera.lens.cx_px, 0, camera.lens.fy_px, camera.lens.cy_px, 0, 0, 1;
  return A;
}

/// Where the display shows a point of the rig, through the undistorted camera picture.
Vector2d shown(const Matrix3d& H_display_camera, const RigCamera& camera, const Vector3d& point_m) {
  const Vector3d pixel =
      H_display_camera * intrinsics(camera) * (camera.R_cam_rig * point_m + camera.t_cam_rig_m);
  return pixel.head<2>() / pixel.z();
}

Vector2d centreOf(const Scene& scene) {
  return {(scene.parameters.width_px - 1.0) / 2, (scene.parameters.height_px - 1.0) / 2};
}

Vector3d sightOf(const RigCamera& camera, const Vector3d& target_m) {
  return (target_m - camera.centre_m()).normalized();
}

Vector3d rightOf(const RigCamera& camera, const Vector3d& target_m) {
  return sightOf(camera, target_m).cross(Vector3d::UnitZ()).normalized();
}

/// The definition written out with matrices and a general inverse, for any f'_m.
Matrix3d byDefinition(const Scene& scene, const RigCamera& camera, double f_view_px) {
  const Vector3d e_z = sightOf(camera, scene.target_m);
  const Vector3d e_x = rightOf(camera, scene.target_m);
  Matrix3d R_view;
  R_view.row(0) = e_x;
  R_view.row(1) = e_z.cross(e_x);
  R_view.row(2) = e_z;
  const Vector2d centre = centreOf(scene);
  const double k = scene.parameters.height_px / scene.rig.reference_height_px;
  Matrix3d A_view;
  A_view << k * f_view_px, 0, centre.x(), 0, k * f_view_px, centre.y(), 0, 0, 1;
  Matrix3d zoom;
  const double s = scene.parameters.zoom;
  zoom << s, 0, (1 - s) * centre.x(), 0, s, (1 - s) * centre.y(), 0, 0, 1;
  return zoom * A_view * R_view * camera.R_cam_rig.inverse() * intrinsics(camera).inverse();
}

double distanceOf(const RigCamera& camera, const Vector3d& point_m) {
  return (point_m - camera.centre_m()).norm();
}

/// Shown length of one metre through the target, along the view's own horizontal.
double barLength(const Matrix3d& H, const RigCamera& camera, const Vector3d& target_m) {
  const Vector3d half_m = 0.5 * rightOf(camera, target_m);
  return (shown(H, camera, target_m + half_m) - shown(H, camera, target_m - half_m)).norm();
}

RC_GTEST_PROP(ConstantView, HasTheTargetAtThePicturesCentre, ()) {
  const Scene scene = randomScene();
  for (const RigCamera& camera : scene.rig.cameras) {
    const View view = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
    RC_ASSERT(view.valid);
    const Vector2d miss =
        shown(matrix(view.H_display_camera), camera, scene.target_m) - centreOf(scene);
    RC_ASSERT(miss.norm() < 0.01);
  }
}

RC_GTEST_PROP(ConstantView, SamplesThePixelWhereOpenCvProjectsTheTarget, ()) {
  const Scene scene = randomScene();
  for (const RigCamera& camera : scene.rig.cameras) {
    const View view = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
    const Vector3d undistorted = matrix(view.H_camera_display) * centreOf(scene).homogeneous();
    const Vector2d plane = {
        (undistorted.x() / undistorted.z() - camera.lens.cx_px) / camera.lens.fx_px,
        (undistorted.y() / undistorted.z() - camera.lens.cy_px) / camera.lens.fy_px};
    const auto sampled = appliance::distortedPixel(camera.lens, {plane.x(), plane.y()});

    const Matrix3d A = intrinsics(camera);
    cv::Matx33d R_cv;
    cv::Matx33d A_cv;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        R_cv(row, column) = camera.R_cam_rig(row, column);
        A_cv(row, column) = A(row, column);
      }
    }
    cv::Vec3d rotation;
    cv::Rodrigues(R_cv, rotation);
    const Vector3d& t = camera.t_cam_rig_m;
    const auto& d = camera.lens.distortion;
    std::vector<cv::Point2d> projected;
    cv::projectPoints(
        std::vector<cv::Point3d>{{scene.target_m.x(), scene.target_m.y(), scene.target_m.z()}},
        rotation, cv::Vec3d(t.x(), t.y(), t.z()), A_cv, std::vector<double>(d.begin(), d.end()),
        projected);
    RC_ASSERT(std::hypot(projected[0].x - sampled[0], projected[0].y - sampled[1]) < 0.01);
  }
}

RC_GTEST_PROP(ConstantView, ShowsOneMetreEquallyLongInAllViews, ()) {
  const Scene scene = randomScene();
  const double expected_px = scene.parameters.zoom * scene.parameters.height_px /
                             scene.rig.reference_height_px * scene.rig.reference_focal_px /
                             scene.rig.reference_distance_m;
  for (const RigCamera& camera : scene.rig.cameras) {
    const View view = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
    const double length_px = barLength(matrix(view.H_display_camera), camera, scene.target_m);
    RC_ASSERT(std::abs(length_px / expected_px - 1) < 0.001);
  }
}

RC_GTEST_PROP(ConstantView, FollowsTheDefinitionAndNotItsMisprint, ()) {
  const Scene scene = randomScene();
  for (const RigCamera& camera : scene.rig.cameras) {
    const View view = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
    const double d = distanceOf(camera, scene.target_m);
    const double ratio = d / scene.rig.reference_distance_m;
    const Matrix3d definition = byDefinition(scene, camera, scene.rig.reference_focal_px * ratio);
    RC_ASSERT(matrix(view.H_display_camera).isApprox(definition, 1e-9));

    // The other way round a bar shrinks with the square of the distance's ratio.
    const Matrix3d misprint = byDefinition(scene, camera, scene.rig.reference_focal_px / ratio);
    const double right_px = barLength(definition, camera, scene.target_m);
    const double wrong_px = barLength(misprint, camera, scene.target_m);
    RC_ASSERT(std::abs(wrong_px / right_px * ratio * ratio - 1) < 1e-6);
    if (std::abs(ratio - 1) > 0.01) {
      RC_ASSERT(std::abs(wrong_px / right_px - 1) > 0.001);
      RC_ASSERT(!matrix(view.H_display_camera).isApprox(misprint, 1e-4));
    }
  }
}

RC_GTEST_PROP(ConstantView, IsUprightAndNotMirrored, ()) {
  const Scene scene = randomScene();
  for (const RigCamera& camera : scene.rig.cameras) {
    const Matrix3d H =
        matrix(viewOf(camera, scene.rig, scene.target_m, scene.parameters).H_display_camera);
    const Vector2d centre = centreOf(scene);
    const Vector2d up = shown(H, camera, scene.target_m + 0.01 * Vector3d::UnitZ()) - centre;
    RC_ASSERT(up.y() < 0);
    RC_ASSERT(std::abs(up.x()) < 1e-6);
    const Vector2d right =
        shown(H, camera, scene.target_m + 0.01 * rightOf(camera, scene.target_m)) - centre;
    RC_ASSERT(right.x() > 0);
    RC_ASSERT(std::abs(right.y()) < 1e-6);
    // The camera's picture is turned and stretched, never turned over.
    RC_ASSERT(H.determinant() > 0);
  }
}

RC_GTEST_PROP(ConstantView, HasInverseHomographies, ()) {
  const Scene scene = randomScene();
  for (const RigCamera& camera : scene.rig.cameras) {
    const View view = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
    const Matrix3d product = matrix(view.H_camera_display) * matrix(view.H_display_camera);
    RC_ASSERT(product.isApprox(Matrix3d::Identity(), 1e-9));
  }
}

RC_GTEST_PROP(ConstantView, StaysTheSameSizeWhenTheAthleteMoves, ()) {
  const Scene scene = randomScene();
  const RigCamera& camera = scene.rig.cameras.front();
  const Vector3d moved_m = scene.target_m + pointWithin(0.2);
  const View before = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
  const View after = viewOf(camera, scene.rig, moved_m, scene.parameters);
  RC_PRE(after.valid);
  const double ratio = barLength(matrix(after.H_display_camera), camera, moved_m) /
                       barLength(matrix(before.H_display_camera), camera, scene.target_m);
  RC_ASSERT(std::abs(ratio - 1) < 0.001);
}

RC_GTEST_PROP(ConstantView, KeepsTheCamerasUpWhereItLooksStraightUpOrDown, ()) {
  const bool down = anyBits<bool>();
  Scene scene = randomScene();
  RigCamera& camera = scene.rig.cameras.front();
  const double z = down ? -1 : 1;
  const double turn = between(-3.1, 3.1);
  camera.R_cam_rig.row(0) = Vector3d(std::cos(turn), std::sin(turn), 0);
  camera.R_cam_rig.row(2) = Vector3d(0, 0, z);
  camera.R_cam_rig.row(1) = camera.R_cam_rig.row(2).cross(camera.R_cam_rig.row(0));
  camera.t_cam_rig_m = Vector3d(0, 0, 3) - camera.R_cam_rig * scene.target_m;
  const View view = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
  RC_ASSERT(view.valid);
  const Matrix3d H = matrix(view.H_display_camera);
  RC_ASSERT((shown(H, camera, scene.target_m) - centreOf(scene)).norm() < 0.01);
  const Vector3d camera_up = -camera.R_cam_rig.row(1).transpose();
  RC_ASSERT(shown(H, camera, scene.target_m + 0.01 * camera_up).y() < centreOf(scene).y());
}

RC_GTEST_PROP(ConstantView, IsInvalidForATargetBehindOrInTheCamera, ()) {
  const Scene scene = randomScene();
  const RigCamera& camera = scene.rig.cameras.front();
  const Vector3d forward = camera.R_cam_rig.row(2);
  const Vector3d behind_m =
      camera.centre_m() - between(0, 20) * forward + between(0, 0.09) * Vector3d::UnitX();
  RC_ASSERT(!viewOf(camera, scene.rig, behind_m, scene.parameters).valid);
  RC_ASSERT(!viewOf(camera, scene.rig, camera.centre_m(), scene.parameters).valid);
}

/// Any finite double: most are absurd, some plausible, some zero or tiny.
double anyFinite() {
  const int kind = anyIn(0, 4);
  if (kind == 0) return 0;
  if (kind == 1) return between(-10, 10);
  const double value = std::bit_cast<double>(anyBits<std::uint64_t>());
  return std::isfinite(value) ? value : std::numeric_limits<double>::max();
}

RC_GTEST_PROP(ConstantView, IsFiniteForAnyFiniteInput, ()) {
  Scene scene = randomScene();
  RigCamera& camera = scene.rig.cameras.front();
  // One to four quantities become anything; with all of them no case gets far.
  const int changes = anyIn(1, 5);
  for (int i = 0; i < changes; ++i) {
    switch (anyIn(0, 10)) {
      case 0:
        camera.lens.fx_px = anyFinite();
        break;
      case 1:
        camera.lens.fy_px = anyFinite();
        break;
      case 2:
        camera.lens.cx_px = anyFinite();
        break;
      case 3:
        camera.R_cam_rig(anyIn(0, 3), anyIn(0, 3)) = anyFinite();
        break;
      case 4:
        camera.t_cam_rig_m[anyIn(0, 3)] = anyFinite();
        break;
      case 5:
        scene.target_m[anyIn(0, 3)] = anyFinite();
        break;
      case 6:
        scene.parameters.zoom = anyFinite();
        break;
      case 7:
        scene.rig.reference_focal_px = anyFinite();
        break;
      case 8:
        scene.rig.reference_distance_m = anyFinite();
        break;
      default:
        scene.parameters.width_px = anyBits<std::uint32_t>();
        break;
    }
  }
  const View view = viewOf(camera, scene.rig, scene.target_m, scene.parameters);
  RC_CLASSIFY(view.valid);
  for (const Homography& H : {view.H_display_camera, view.H_camera_display}) {
    for (const double element : H) RC_ASSERT(std::isfinite(element));
  }
}

}  // namespace

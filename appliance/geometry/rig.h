#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hal/lens.h"

namespace appliance {

/// More cameras than any arc we build; fixed so that real-time code can use arrays.
inline constexpr std::size_t kMaxCameras = 64;

/// One camera as calibrated. Camera axes: x right, y down, z forward.
struct RigCamera {
  std::string name;  ///< as in the rig file, unique
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  hal::Lens lens;
  Eigen::Matrix3d R_cam_rig = Eigen::Matrix3d::Identity();  ///< proper rotation
  Eigen::Vector3d t_cam_rig_m = Eigen::Vector3d::Zero();    ///< x_cam = R x_rig + t
  std::array<float, 3> gain_rgb{1, 1, 1};                   ///< applied in linear light

  /// C_m, where the camera stands: -R^T t.
  [[nodiscard]] Eigen::Vector3d centre_m() const { return -(R_cam_rig.transpose() * t_cam_rig_m); }
};

/// The arc of cameras. Rig frame: metres, +Z up, origin on the floor.
///
/// Memory  Immutable once loaded; threads share it by reference.
struct Rig {
  std::string name;
  std::vector<RigCamera> cameras;  ///< in the file's order: camera 0 is the arc's left end
  Eigen::Vector3d target_m = Eigen::Vector3d::Zero();  ///< the working point
  /// Together they fix the subject's size in every view: at reference_distance_m a length
  /// is drawn as a camera of reference_focal_px would draw it.
  double reference_focal_px = 0;
  double reference_distance_m = 0;
  double reference_height_px = 0;  ///< mean height of the cameras' pictures
};

/// The means that a rig file need not state: focal length, distance to rig.target_m, height.
/// Call with cameras and target set; fills only the references that are still zero.
void fillReferences(Rig& rig);

}  // namespace appliance

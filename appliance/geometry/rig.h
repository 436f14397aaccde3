#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hal/colour_model.h"
#include "hal/lens.h"
#include "hal/pixel_format.h"

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
  hal::ColourModel colour;
  hal::PixelFormat pixel_format = hal::PixelFormat::kBayerRG8;

  /// C_m, where the camera stands: -R^T t.
  [[nodiscard]] Eigen::Vector3d centre_m() const { return -(R_cam_rig.transpose() * t_cam_rig_m); }
};

/// Where the target point may be: an upright cylinder or a box along the rig's axes.
struct TargetVolume {
  enum class Shape : std::uint8_t { kCylinder, kBox };
  Shape shape = Shape::kCylinder;
  std::optional<Eigen::Vector3d> centre_m;  ///< none: Rig::target_m
  Eigen::Vector3d half_size_m =
      Eigen::Vector3d::Zero();  ///< of a cylinder: radius, radius, half height
};

/// The arc of cameras. Rig frame: metres, +Z up, origin on the floor.
///
/// Memory  Immutable once loaded; threads share it by reference.
struct Rig {
  std::string name;
  std::vector<RigCamera> cameras;  ///< in the file's order: camera 0 is the arc's left end
  Eigen::Vector3d target_m = Eigen::Vector3d::Zero();  ///< the working point
  TargetVolume target_volume;  ///< the views cover the screen for every target in it
  /// Together they fix the subject's size in every view: at reference_distance_m a length
  /// is drawn as a camera of reference_focal_px would draw it.
  double reference_focal_px = 0;
  double reference_distance_m = 0;
  double reference_height_px = 0;  ///< mean height of the cameras' pictures

  std::vector<std::string> warnings;  ///< what its file said that was ignored, one line each
};

/// The means that a rig file need not state: focal length, distance to rig.target_m, height.
/// Call with cameras and target set; fills only the references that are still zero.
void fillReferences(Rig& rig);

}  // namespace appliance

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hal/emulated/rig/rig_file.h"

namespace emulator::studio {

/// A camera as it really is, beyond what a calibration knows.
struct StudioCamera {
  CameraModel model;                        ///< with the colour gains that undo response
  std::array<double, 3> response{1, 1, 1};  ///< what sensor and amplifier make of white light
  double vignetting = 0;                    ///< light lost at the picture's corner, 0..1
  double exposure_s = 0.002;
  double read_noise_dn = 1;      ///< of 255
  double electrons_per_dn = 45;  ///< sets the noise of the light itself

  [[nodiscard]] Eigen::Matrix3d rotation() const;
  [[nodiscard]] Eigen::Vector3d centre() const;
  /// Share of the light that reaches a pixel.
  [[nodiscard]] double falloff(double x_px, double y_px) const;
  /// OpenCV's model, see calib3d's projectPoints.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point_rig_m) const;
};

struct StudioRig {
  std::vector<StudioCamera> cameras;

  [[nodiscard]] RigModel model() const;
};

/// Cameras on a U-shaped arc of 110 degrees about the origin (closer than 5.8 degrees only where
/// more than 20 share it), 4 m away, 1.2 m high, aimed at chest height by human hands.
[[nodiscard]] StudioRig makeStudioRig(std::uint32_t cameras, SizePx size, std::uint64_t seed);

}  // namespace emulator::studio

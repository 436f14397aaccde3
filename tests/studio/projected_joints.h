#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "hal/emulated/studio/studio_rig.h"

/// Where OpenCV's lens model puts points of the hall in a camera's picture.
[[nodiscard]] std::vector<cv::Point2d> projectJoints(std::span<const Eigen::Vector3d> joints_rig_m,
                                                     const emulator::studio::StudioCamera& camera);

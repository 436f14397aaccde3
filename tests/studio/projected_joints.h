#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "hal/emulated/studio/studio_rig.h"
#include "hal/emulated/studio/world.h"

/// Where OpenCV's lens model puts points of the hall in a camera's picture.
[[nodiscard]] std::vector<cv::Point2d> projectJoints(std::span<const Eigen::Vector3d> joints_rig_m,
                                                     const emulator::studio::StudioCamera& camera);

/// Which of the athlete's joints other people cover: others who stand nearer, their trunks and
/// limbs as thick as people's are.
[[nodiscard]] std::array<bool, 17> coveredJoints(const emulator::studio::World& world,
                                                 double second,
                                                 const emulator::studio::StudioCamera& camera,
                                                 const std::array<Eigen::Vector3d, 17>& joints,
                                                 const std::vector<cv::Point2d>& seen);

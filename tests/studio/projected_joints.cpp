#include "tests/studio/projected_joints.h"

#include <opencv2/calib3d.hpp>

std::vector<cv::Point2d> projectJoints(std::span<const Eigen::Vector3d> joints_rig_m,
                                       const emulator::studio::StudioCamera& camera) {
  const auto& m = camera.model;
  std::vector<cv::Point3d> points;
  for (const Eigen::Vector3d& joint : joints_rig_m)
    points.emplace_back(joint.x(), joint.y(), joint.z());
  cv::Matx33d rotation;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k)
      rotation(i, k) = m.rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  }
  cv::Vec3d turn;
  cv::Rodrigues(rotation, turn);
  const cv::Matx33d lens(m.focal_px[0], 0, m.centre_px[0], 0, m.focal_px[1], m.centre_px[1], 0, 0,
                         1);
  std::vector<cv::Point2d> seen;
  cv::projectPoints(points, turn, cv::Vec3d(m.translation_m.data()), lens,
                    cv::Mat(1, 5, CV_64F, const_cast<double*>(m.distortion.data())), seen);
  return seen;
}

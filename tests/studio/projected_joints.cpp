#include "tests/studio/projected_joints.h"

#include <utility>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

using namespace emulator::studio;  // NOLINT(google-build-using-namespace)

std::vector<cv::Point2d> projectJoints(std::span<const Eigen::Vector3d> joints_rig_m,
                                       const StudioCamera& camera) {
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

std::array<bool, 17> coveredJoints(const World& world, double second, const StudioCamera& camera,
                                   const std::array<Eigen::Vector3d, 17>& joints,
                                   const std::vector<cv::Point2d>& seen) {
  const auto depthOf = [&](const Eigen::Vector3d& point) {
    return camera.rotation().row(2).dot(point - camera.centre());
  };
  cv::Mat others(static_cast<int>(camera.model.image_size.height),
                 static_cast<int>(camera.model.image_size.width), CV_8U, cv::Scalar::all(0));
  for (std::size_t i = 1; i < world.peopleCount(); ++i) {
    const PoseAt pose = world.person(i).at(second);
    const double away = depthOf((pose.joints[11] + pose.joints[12]) / 2);
    if (away < 0.5 || away > depthOf((joints[11] + joints[12]) / 2)) continue;
    const std::vector<cv::Point2d> at = projectJoints(pose.joints, camera);
    const auto thick = [&](int a, int b, double width_m) {
      cv::line(others, cv::Point(at[static_cast<std::size_t>(a)]),
               cv::Point(at[static_cast<std::size_t>(b)]), cv::Scalar::all(255),
               static_cast<int>(width_m * camera.model.focal_px[0] / away));
    };
    for (const auto& [a, b] : {std::pair(5, 6), {5, 11}, {6, 12}, {11, 12}, {5, 12}, {6, 11}})
      thick(a, b, 0.2);
    for (const auto& [a, b] : {std::pair(11, 13), {13, 15}, {12, 14}, {14, 16}}) thick(a, b, 0.13);
    for (const auto& [a, b] : {std::pair(5, 7), {7, 9}, {6, 8}, {8, 10}}) thick(a, b, 0.08);
    thick(3, 4, 0.2);
  }
  std::array<bool, 17> covered{};
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const cv::Point pixel(seen[i]);
    covered[i] = cv::Rect(0, 0, others.cols, others.rows).contains(pixel) &&
                 others.at<std::uint8_t>(pixel) != 0;
  }
  return covered;
}

#include "tests/support/shown_picture.h"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace test {

cv::Point2d ShownPicture::toDisplay(cv::Point2d source_px) const {
  // With OpenCV alone, so that our own lens and homography are judged by another party.
  std::vector<cv::Point2d> undistorted;
  cv::undistortPoints(std::vector<cv::Point2d>{source_px}, undistorted, camera_matrix, distortion,
                      cv::noArray(), camera_matrix);
  const cv::Vec3d shown = H_camera_display.inv() * cv::Vec3d(undistorted[0].x, undistorted[0].y, 1);
  return {shown[0] / shown[2], shown[1] / shown[2]};
}

std::optional<emulator::Stamp> ShownPicture::readStamp(cv::Size source_size) const {
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  const auto layout = emulator::StampLayout::of(source_size.width, source_size.height);
  return emulator::decodeStamp(layout, [&](double x_px, double y_px) -> double {
    const cv::Point2d at = toDisplay({x_px, y_px});
    const cv::Point pixel(cvRound(at.x), cvRound(at.y));
    return pixel.inside({{0, 0}, grey.size()}) ? grey.at<unsigned char>(pixel) : 0;
  });
}

std::vector<ShownPicture> readStills(const std::filesystem::path& folder) {
  std::vector<ShownPicture> stills;
  std::ifstream lines(folder / "pictures.jsonl");
  for (std::string line; std::getline(lines, line);) {
    const auto record = nlohmann::json::parse(line);
    if (record["still"].is_null()) continue;
    ShownPicture shown;
    shown.name = record["still"];
    shown.mode = record["mode"];
    shown.camera = record["camera"];
    shown.trigger = record["trigger"];
    const std::vector<double> homography = record["H_camera_display"];
    std::ranges::copy(homography, shown.H_camera_display.val);
    const std::vector<double> focal_px = record["focal_px"];
    const std::vector<double> centre_px = record["centre_px"];
    shown.camera_matrix = {focal_px[0], 0, centre_px[0], 0, focal_px[1], centre_px[1], 0, 0, 1};
    const std::vector<double> distortion = record["distortion"];
    std::ranges::copy(distortion, shown.distortion.val);
    shown.picture = cv::imread(folder / shown.name, cv::IMREAD_COLOR);
    stills.push_back(std::move(shown));
  }
  return stills;
}

}  // namespace test

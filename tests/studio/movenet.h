#pragma once

#include <array>
#include <expected>
#include <filesystem>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>

/// A joint as a posture network sees it.
struct SeenJoint {
  cv::Point2f at_px;
  float confidence = 0;  ///< 0..1
};

/// MoveNet (Thunder) of Google Research, from the files that its JavaScript release consists of: a
/// graph in JSON and the weights. It stands for whatever network tracks people some day; it never
/// saw a picture of ours.
///
/// Errors   Files that are no such network.
class MoveNet {
 public:
  /// @p folder  has movenet-thunder.json and movenet-thunder.bin.
  [[nodiscard]] static std::expected<MoveNet, std::string> load(
      const std::filesystem::path& folder);

  /// The 17 joints (COCO order) of the person in the middle of a square of the picture; the square
  /// may reach beyond it.
  [[nodiscard]] std::array<SeenJoint, 17> find(const cv::Mat& bgr, const cv::Rect2f& square);

 private:
  explicit MoveNet(const cv::dnn::Net& net) : net_(net) {}

  cv::dnn::Net net_;
};

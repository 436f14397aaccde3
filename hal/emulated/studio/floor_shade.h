#pragma once

#include <cmath>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace emulator::studio {

/// How much of its light the floor keeps among the people, seen from above. Pure.
struct FloorShade {
  static constexpr int kColumns = 280;
  static constexpr int kRows = 260;
  static constexpr float kLowX_m = -7.0f;
  static constexpr float kLowY_m = -5.5f;
  static constexpr float kStep_m = 0.05f;
  /// Where more than this is left, shade drowns in the noise and is none.
  static constexpr float kFaintest = 0.988f;
  cv::Mat share;  ///< CV_32F, row 0 at kLowY_m; 1 where no person is

  /// Column and row of a point (rig frame, metres) among the cells; empty where it is not of the
  /// floor or no four cells lie around it.
  [[nodiscard]] static std::optional<Eigen::Vector2d> cellOf(const Eigen::Vector3d& point) {
    const Eigen::Vector2d cell((point.x() - kLowX_m) / kStep_m - 0.5,
                               (point.y() - kLowY_m) / kStep_m - 0.5);
    const bool inside = std::abs(point.z()) < 0.02 && cell.x() >= 0 && cell.y() >= 0 &&
                        cell.x() < kColumns - 1 && cell.y() < kRows - 1;
    return inside ? std::optional(cell) : std::nullopt;
  }
  /// Between the four cells around a place that cellOf() gave.
  [[nodiscard]] float at(float column, float row) const {
    const int x = static_cast<int>(column);
    const int y = static_cast<int>(row);
    const float u = column - static_cast<float>(x);
    const float v = row - static_cast<float>(y);
    const auto* low = share.ptr<float>(y) + x;
    const auto* high = share.ptr<float>(y + 1) + x;
    return (low[0] * (1 - u) + low[1] * u) * (1 - v) + (high[0] * (1 - u) + high[1] * u) * v;
  }
};

}  // namespace emulator::studio

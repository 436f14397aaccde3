#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "hal/emulated/studio/surfaces.h"

namespace emulator::studio {

/// Answers what a ray meets first among the hall's surfaces. Nets and what glows are not met:
/// light passes the ones and comes from the others.
class RayScene {
 public:
  explicit RayScene(const std::vector<Surface>& surfaces);

  struct Hit {
    std::uint32_t surface = 0;
    float u = 0;  ///< within the surface
    float v = 0;
    float distance = 0;
    bool front = false;  ///< met from the side that its normal shows to
  };
  /// @p direction has length 1.
  [[nodiscard]] std::optional<Hit> firstHit(const Eigen::Vector3f& origin,
                                            const Eigen::Vector3f& direction) const;
  /// Whether anything lies between two points.
  [[nodiscard]] bool blocked(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;

 private:
  struct Triangle {
    Eigen::Vector3f corner;
    Eigen::Vector3f edge_a;
    Eigen::Vector3f edge_b;
    std::uint32_t surface;
    bool upper;  // the half at (1, 1)
  };
  struct Node {
    Eigen::Vector3f low;
    Eigen::Vector3f high;
    std::uint32_t first = 0;  // triangle, or right child (the left one follows its parent)
    std::uint32_t count = 0;  // 0: inner
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  /// Calls @p take(triangle, distance, u, v) for each triangle nearer than the limit it returns.
  template <typename Take>
  void walk(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float limit,
            Take take) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace emulator::studio

#include "hal/emulated/studio/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace emulator::studio {

using Eigen::Vector3f;

namespace {
constexpr std::uint32_t kLeaf = 4;
constexpr float kNearest_m = 1e-4f;
}  // namespace

RayScene::RayScene(const std::vector<Surface>& surfaces) {
  for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
    const Surface& s = surfaces[i];
    if (s.cover == Cover::kNet || s.cover == Cover::kGlow) continue;
    const auto& c = s.corners;
    triangles_.push_back({c[0], c[1] - c[0], c[2] - c[0], i, false});
    triangles_.push_back({c[3], c[2] - c[3], c[1] - c[3], i, true});
  }
  nodes_.reserve(triangles_.size());
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::uint32_t RayScene::build(std::uint32_t first, std::uint32_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Vector3f low = Vector3f::Constant(std::numeric_limits<float>::max());
  Vector3f high = -low;
  Vector3f centre_low = low;
  Vector3f centre_high = high;
  const auto centre = [](const Triangle& t) -> Vector3f {
    return t.corner + (t.edge_a + t.edge_b) / 3;
  };
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Triangle& t = triangles_[i];
    for (const Vector3f& p :
         {t.corner, Vector3f(t.corner + t.edge_a), Vector3f(t.corner + t.edge_b)}) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    centre_low = centre_low.cwiseMin(centre(t));
    centre_high = centre_high.cwiseMax(centre(t));
  }
  nodes_[index].low = low;
  nodes_[index].high = high;
  if (count <= kLeaf) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return index;
  }
  Eigen::Index axis = 0;
  (centre_high - centre_low).maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = triangles_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](const Triangle& a, const Triangle& b) {
    return centre(a)[axis] < centre(b)[axis];
  });
  build(first, half);
  const std::uint32_t right = build(first + half, count - half);
  nodes_[index].first = right;
  return index;
}

template <typename Take>
void RayScene::walk(const Vector3f& origin, const Vector3f& direction, float limit,
                    Take take) const {
  if (nodes_.empty()) return;
  const Vector3f inverse = direction.cwiseInverse();
  std::array<std::uint32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = nodes_[index];
    const Vector3f a = (node.low - origin).cwiseProduct(inverse);
    const Vector3f b = (node.high - origin).cwiseProduct(inverse);
    const float enter = a.cwiseMin(b).maxCoeff();
    const float leave = a.cwiseMax(b).minCoeff();
    if (leave < std::max(enter, 0.0f) || enter > limit) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = index + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[i];
      const Vector3f p = direction.cross(t.edge_b);
      const float determinant = t.edge_a.dot(p);
      if (std::abs(determinant) < 1e-12f) continue;
      const float scale = 1 / determinant;
      const Vector3f s = origin - t.corner;
      const float u = s.dot(p) * scale;
      if (u < 0 || u > 1) continue;
      const Vector3f q = s.cross(t.edge_a);
      const float v = direction.dot(q) * scale;
      if (v < 0 || u + v > 1) continue;
      const float distance = t.edge_b.dot(q) * scale;
      if (distance > kNearest_m && distance < limit) {
        limit = take(t, distance, u, v, determinant);
        if (limit <= 0) return;
      }
    }
  }
}

std::optional<RayScene::Hit> RayScene::firstHit(const Vector3f& origin,
                                                const Vector3f& direction) const {
  std::optional<Hit> nearest;
  walk(origin, direction, std::numeric_limits<float>::max(),
       [&](const Triangle& t, float distance, float u, float v, float determinant) {
         nearest = Hit{.surface = t.surface,
                       .u = t.upper ? 1 - u : u,
                       .v = t.upper ? 1 - v : v,
                       .distance = distance,
                       .front = determinant > 0};
         return distance;
       });
  return nearest;
}

bool RayScene::blocked(const Vector3f& from, const Vector3f& to) const {
  const Vector3f way = to - from;
  const float length = way.norm();
  bool hit = false;
  walk(from, way / length, length - kNearest_m, [&](const Triangle&, float, float, float, float) {
    hit = true;
    return 0.0f;
  });
  return hit;
}

}  // namespace emulator::studio

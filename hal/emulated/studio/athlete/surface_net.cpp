#include "hal/emulated/studio/athlete/surface_net.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace emulator::studio {
namespace {

constexpr int kBlock = 8;       // cells along a block's edge
constexpr float kSlack = 1.5F;  // how much the field may overstate a distance

class Grid {
 public:
  Grid(const Field& field, const GridLines& x, const GridLines& y, const GridLines& z)
      : field_(field), lines_{&x, &y, &z} {
    for (std::size_t a = 0; a < 3; ++a) size_[a] = static_cast<int>(lines_[a]->size());
    values_.assign(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                       static_cast<std::size_t>(size_[2]),
                   1.0F);
    for (int k = 0; k < size_[2]; k += kBlock) {
      for (int j = 0; j < size_[1]; j += kBlock) {
        for (int i = 0; i < size_[0]; i += kBlock) fillBlock(i, j, k);
      }
    }
  }

  [[nodiscard]] int size(std::size_t axis) const { return size_[axis]; }
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(i);
  }
  [[nodiscard]] float value(int i, int j, int k) const { return values_[index(i, j, k)]; }
  [[nodiscard]] Point at(int i, int j, int k) const {
    return {(*lines_[0])[static_cast<std::size_t>(i)], (*lines_[1])[static_cast<std::size_t>(j)],
            (*lines_[2])[static_cast<std::size_t>(k)]};
  }

 private:
  void fillBlock(int i0, int j0, int k0) {
    const std::array<int, 3> end{std::min(i0 + kBlock, size_[0] - 1),
                                 std::min(j0 + kBlock, size_[1] - 1),
                                 std::min(k0 + kBlock, size_[2] - 1)};
    const Point low = at(i0, j0, k0);
    const Point high = at(end[0], end[1], end[2]);
    const float centre = field_((low + high) / 2);
    const bool far = std::abs(centre) > kSlack * (high - low).norm() / 2;
    // A block owns its low border; the high one belongs to the next.
    for (int k = k0; k < std::min(size_[2], k0 + kBlock); ++k) {
      for (int j = j0; j < std::min(size_[1], j0 + kBlock); ++j) {
        for (int i = i0; i < std::min(size_[0], i0 + kBlock); ++i) {
          values_[index(i, j, k)] = far ? centre : field_(at(i, j, k));
        }
      }
    }
  }

  const Field& field_;
  std::array<const GridLines*, 3> lines_;
  std::array<int, 3> size_{};
  std::vector<float> values_;
};

constexpr std::array<std::array<int, 3>, 8> kCorners{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};
constexpr std::array<std::array<int, 2>, 12> kEdges{{{0, 1},
                                                     {2, 3},
                                                     {4, 5},
                                                     {6, 7},
                                                     {0, 2},
                                                     {1, 3},
                                                     {4, 6},
                                                     {5, 7},
                                                     {0, 4},
                                                     {1, 5},
                                                     {2, 6},
                                                     {3, 7}}};

/// The mean of the points where the surface crosses the cell's edges; none: no vertex.
bool cellVertex(const Grid& grid, int i, int j, int k, Point& vertex) {
  std::array<float, 8> value{};
  int inside = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    value[c] = grid.value(i + kCorners[c][0], j + kCorners[c][1], k + kCorners[c][2]);
    if (value[c] < 0) ++inside;
  }
  if (inside == 0 || inside == 8) return false;
  const Point low = grid.at(i, j, k);
  const Point extent = grid.at(i + 1, j + 1, k + 1) - low;
  Point sum = Point::Zero();
  int crossings = 0;
  for (const auto& edge : kEdges) {
    const auto a = static_cast<std::size_t>(edge[0]);
    const auto b = static_cast<std::size_t>(edge[1]);
    if ((value[a] < 0) == (value[b] < 0)) continue;
    const float t = value[a] / (value[a] - value[b]);
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<std::size_t>(axis);
      const auto from = static_cast<float>(kCorners[a][x]);
      const auto to = static_cast<float>(kCorners[b][x]);
      sum[axis] += from + (to - from) * t;
    }
    ++crossings;
  }
  vertex = low + extent.cwiseProduct(sum / static_cast<float>(crossings));
  return true;
}

Point gradient(const Field& field, const Point& p) {
  constexpr float kStep = 0.0008F;
  Point g;
  for (int axis = 0; axis < 3; ++axis) {
    Point step = Point::Zero();
    step[axis] = kStep;
    g[axis] = (field(p + step) - field(p - step)) / (2 * kStep);
  }
  return g;
}

/// Onto the surface, at most @p limit away.
void settle(const Field& field, float limit, Point& p, Point& normal) {
  const Point start = p;
  Point g = gradient(field, p);
  for (int round = 0; round < 2; ++round) {
    const float slope = std::max(g.squaredNorm(), 0.1F);
    p -= g * (field(p) / slope);
    const Point moved = p - start;
    if (moved.norm() > limit) p = start + moved.normalized() * limit;
    g = gradient(field, p);
  }
  normal = g.norm() > 1e-4F ? Point(g.normalized()) : Point(Point::UnitZ());
}

}  // namespace

GridLines gridLines(float from, float to, float cell_m, const std::vector<FineRange>& fine) {
  const auto sizeAt = [&](float x) {
    float size = cell_m;
    for (const auto& range : fine) {
      const float away = std::max({range.from - x, x - range.to, 0.0F});
      size = std::min(size, range.cell_m + 0.2F * away);
    }
    return size;
  };
  GridLines lines{from};
  while (lines.back() < to) lines.push_back(lines.back() + sizeAt(lines.back()));
  return lines;
}

Polygons polygonise(const Field& field, const GridLines& x, const GridLines& y,
                    const GridLines& z) {
  const Grid grid(field, x, y, z);
  Polygons surface;
  constexpr auto kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> cell(static_cast<std::size_t>(grid.size(0)) *
                                      static_cast<std::size_t>(grid.size(1)) *
                                      static_cast<std::size_t>(grid.size(2)),
                                  kNone);
  for (int k = 0; k + 1 < grid.size(2); ++k) {
    for (int j = 0; j + 1 < grid.size(1); ++j) {
      for (int i = 0; i + 1 < grid.size(0); ++i) {
        Point vertex;
        if (!cellVertex(grid, i, j, k, vertex)) continue;
        Point normal;
        const float cell_size = (grid.at(i + 1, j + 1, k + 1) - grid.at(i, j, k)).minCoeff();
        settle(field, 0.5F * cell_size, vertex, normal);
        cell[grid.index(i, j, k)] = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.push_back(vertex);
        surface.normals.push_back(normal);
      }
    }
  }
  // A grid edge that crosses the surface joins the four cells around it.
  for (int k = 1; k + 1 < grid.size(2); ++k) {
    for (int j = 1; j + 1 < grid.size(1); ++j) {
      for (int i = 1; i + 1 < grid.size(0); ++i) {
        const bool inside = grid.value(i, j, k) < 0;
        for (int axis = 0; axis < 3; ++axis) {
          const std::array<int, 3> d{axis == 0, axis == 1, axis == 2};
          if (inside == (grid.value(i + d[0], j + d[1], k + d[2]) < 0)) continue;
          const std::array<int, 3> u{axis == 2, axis == 0, axis == 1};  // the axis after
          const std::array<int, 3> v{axis == 1, axis == 2, axis == 0};  // and the one after that
          const auto at = [&](int a, int b) {
            return cell[grid.index(i - a * u[0] - b * v[0], j - a * u[1] - b * v[1],
                                   k - a * u[2] - b * v[2])];
          };
          std::array<std::uint32_t, 4> quad{at(1, 1), at(0, 1), at(0, 0), at(1, 0)};
          if (!inside) std::swap(quad[1], quad[3]);
          // The shorter diagonal.
          const auto& p = surface.positions;
          const bool flip =
              (p[quad[0]] - p[quad[2]]).squaredNorm() > (p[quad[1]] - p[quad[3]]).squaredNorm();
          if (flip) std::rotate(quad.begin(), quad.begin() + 1, quad.end());
          surface.triangles.insert(surface.triangles.end(),
                                   {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
        }
      }
    }
  }
  return surface;
}

}  // namespace emulator::studio

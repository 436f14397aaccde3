#include "ui-kms/warp_mesh.h"

#include <algorithm>
#include <cassert>

namespace ui {
namespace {

// Where a corner's lookup falls. Four corners beyond the same side: the whole cell is.
constexpr std::uint8_t kBehind = 1;  ///< w <= 0, or not a number
constexpr std::uint8_t kBeyondLens = 2;
constexpr std::uint8_t kMasked = 128;  ///< in the soft edge or beyond it
constexpr std::uint8_t kLeft = 4, kRight = 8, kAbove = 16, kBelow = 32;  ///< a texel or more out
constexpr std::uint8_t kOffSource = 64;  ///< any part of the bilinear footprint outside

/// How far the mesh may differ from the lens between corners; generous.
constexpr double kMeshErrorPx = 4;

std::uint8_t sideBits(double u_px, double v_px, double width_px, double height_px) {
  std::uint8_t bits = 0;
  if (u_px < -1 - kMeshErrorPx) bits |= kLeft;
  if (u_px > width_px + kMeshErrorPx) bits |= kRight;
  if (v_px < -1 - kMeshErrorPx) bits |= kAbove;
  if (v_px > height_px + kMeshErrorPx) bits |= kBelow;
  const bool inside = u_px >= 0 && v_px >= 0 && u_px <= width_px - 1 && v_px <= height_px - 1;
  if (!inside) bits |= kOffSource;
  return bits;
}

}  // namespace

WarpMesh::WarpMesh(std::uint32_t width_px, std::uint32_t height_px)
    : width_px_(width_px),
      height_px_(height_px),
      columns_((width_px + kCellPx - 1) / kCellPx + 1),
      rows_((height_px + kCellPx - 1) / kCellPx + 1) {
  const std::size_t corners = std::size_t{columns_} * rows_;
  assert(corners <= 65536 && "indices are 16 bits wide");
  vertices_.resize(corners);
  where_.resize(corners);
  inner_.reserve(corners * 6);
  edge_.reserve(corners * 6);
}

double WarpMesh::columnPx(std::uint32_t i) const {
  return std::min(i * kCellPx, width_px_) - 0.5;
}
double WarpMesh::rowPx(std::uint32_t j) const {
  return std::min(j * kCellPx, height_px_) - 0.5;
}

void WarpMesh::updateVertices(const hal::WarpPlan& plan) {
  const auto& h = plan.H_camera_display;
  const auto& lens = plan.lens;
  const auto [k1, k2, p1, p2, k3] = lens.distortion;
  const double width_px = plan.source.width_px;
  const double height_px = plan.source.height_px;
  const double max_radius2 = lens.max_radius * lens.max_radius;
  const bool masked = plan.edge.active();
  for (std::uint32_t j = first_row_; j <= last_row_; ++j) {
    const double y_px = rowPx(j);
    for (std::uint32_t i = first_column_; i <= last_column_; ++i) {
      const double x_px = columnPx(i);
      const std::size_t at = std::size_t{j} * columns_ + i;
      const double ray_x = h[0] * x_px + h[1] * y_px + h[2];
      const double ray_y = h[3] * x_px + h[4] * y_px + h[5];
      const double w = h[6] * x_px + h[7] * y_px + h[8];
      WarpVertex& vertex = vertices_[at];
      vertex.ray_x = static_cast<float>(ray_x);
      vertex.ray_y = static_cast<float>(ray_y);
      vertex.ray_w = static_cast<float>(w);
      if (!(w > 0)) {
        where_[at] = kBehind;
        continue;
      }
      // Brown-Conrady in OpenCV's convention, on coordinates in units of the focal length.
      const double x = (ray_x / w - lens.cx_px) / lens.fx_px;
      const double y = (ray_y / w - lens.cy_px) / lens.fy_px;
      const double r2 = x * x + y * y;
      if (!(r2 <= max_radius2)) {
        where_[at] = kBeyondLens;
        continue;
      }
      const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
      const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
      const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
      const double u_px = lens.fx_px * xd + lens.cx_px;
      const double v_px = lens.fy_px * yd + lens.cy_px;
      vertex.texture_u_w = static_cast<float>((u_px + 0.5) / width_px * w);
      vertex.texture_v_w = static_cast<float>((v_px + 0.5) / height_px * w);
      vertex.texture_w = static_cast<float>(w);
      where_[at] = sideBits(u_px, v_px, width_px, height_px);
      if (masked && plan.edge.at((x_px + 0.5) / width_px_ * 2 - 1,
                                 (y_px + 0.5) / height_px_ * 2 - 1) > hal::EdgeMask::kNone)
        where_[at] |= kMasked;
    }
  }
}

WarpMesh::Cell WarpMesh::classify(std::size_t first) const {
  const std::uint8_t a = where_[first];
  const std::uint8_t b = where_[first + 1];
  const std::uint8_t c = where_[first + columns_];
  const std::uint8_t d = where_[first + columns_ + 1];
  if ((a | b | c | d) == 0) return Cell::kInner;
  constexpr std::uint8_t kCertain = kBehind | kLeft | kRight | kAbove | kBelow;
  return (a & b & c & d & kCertain) != 0 ? Cell::kOutside : Cell::kEdge;
}

void WarpMesh::choose(const hal::RectPx& where) {
  const auto cell = [](std::int32_t px) { return static_cast<std::uint32_t>(px) / kCellPx; };
  first_column_ = cell(where.x);
  first_row_ = cell(where.y);
  last_column_ = cell(where.x + where.width - 1) + 1;
  last_row_ = cell(where.y + where.height - 1) + 1;
}

void WarpMesh::update(const hal::WarpPlan& plan, const hal::RectPx& where) {
  inner_.clear();
  edge_.clear();
  const auto drawn = common(
      where, {0, 0, static_cast<std::int32_t>(width_px_), static_cast<std::int32_t>(height_px_)});
  if (drawn.empty()) return;
  choose(drawn);
  updateVertices(plan);
  for (std::uint32_t j = first_row_; j < last_row_; ++j) {
    for (std::uint32_t i = first_column_; i < last_column_; ++i) {
      const std::size_t first = std::size_t{j} * columns_ + i;
      const Cell cell = classify(first);
      if (cell == Cell::kOutside) continue;
      auto& indices = cell == Cell::kInner ? inner_ : edge_;
      const auto a = static_cast<std::uint16_t>(first);
      const auto b = static_cast<std::uint16_t>(first + 1);
      const auto c = static_cast<std::uint16_t>(first + columns_);
      const auto d = static_cast<std::uint16_t>(first + columns_ + 1);
      indices.insert(indices.end(), {a, b, c, b, d, c});
    }
  }
}

}  // namespace ui

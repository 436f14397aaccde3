#include "ui-kms/warp_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace ui {
namespace {

// Where a corner's lookup falls. Four corners beyond the same side: the whole cell is.
constexpr std::uint16_t kBehind = 1;  ///< w <= 0, or not a number
constexpr std::uint16_t kBeyondLens = 2;
constexpr std::uint16_t kLeft = 4, kRight = 8, kAbove = 16, kBelow = 32;  ///< a texel or more out
constexpr std::uint16_t kOffSource = 64;  ///< any part of the bilinear footprint outside
constexpr std::uint16_t kSoftened = 128;  ///< in the soft edge or beyond it
constexpr std::uint16_t kMaskedOut = 256;
constexpr std::uint16_t kMaskBends = 512;  ///< not of the corner: in the cell that begins there

/// How far the mesh may differ from the lens between corners; generous.
constexpr double kMeshErrorPx = 4;

std::uint16_t sideBits(double u_px, double v_px, double width_px, double height_px) {
  std::uint16_t bits = 0;
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
  for (auto* indices : {&inner_, &soft_, &edge_}) indices->reserve(corners * 6);
}

double WarpMesh::columnPx(std::uint32_t i) const {
  return std::min(i * kCellPx, width_px_) - 0.5;
}
double WarpMesh::rowPx(std::uint32_t j) const {
  return std::min(j * kCellPx, height_px_) - 0.5;
}

void WarpMesh::updateVertices(const hal::WarpPlan& plan) {
  for (std::uint32_t j = first_row_; j <= last_row_; ++j) {
    for (std::uint32_t i = first_column_; i <= last_column_; ++i) {
      const std::size_t at = std::size_t{j} * columns_ + i;
      where_[at] = place(plan, columnPx(i), rowPx(j), vertices_[at]);
    }
  }
  if (plan.edge.active()) mask(plan.edge);
}

/// One corner's vertex, and where its lookup falls.
std::uint16_t WarpMesh::place(const hal::WarpPlan& plan, double x_px, double y_px,
                              WarpVertex& vertex) const {
  const auto& h = plan.H_camera_display;
  const auto& lens = plan.lens;
  const double width_px = plan.source.width_px;
  const double height_px = plan.source.height_px;
  const double ray_x = h[0] * x_px + h[1] * y_px + h[2];
  const double ray_y = h[3] * x_px + h[4] * y_px + h[5];
  const double w = h[6] * x_px + h[7] * y_px + h[8];
  vertex.ray_x = static_cast<float>(ray_x);
  vertex.ray_y = static_cast<float>(ray_y);
  vertex.ray_w = static_cast<float>(w);
  if (!(w > 0)) return kBehind;
  // Brown-Conrady in OpenCV's convention, on coordinates in units of the focal length.
  const auto [k1, k2, p1, p2, k3] = lens.distortion;
  const double x = (ray_x / w - lens.cx_px) / lens.fx_px;
  const double y = (ray_y / w - lens.cy_px) / lens.fy_px;
  const double r2 = x * x + y * y;
  if (!(r2 <= lens.max_radius * lens.max_radius)) return kBeyondLens;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  const double u_px = lens.fx_px * xd + lens.cx_px;
  const double v_px = lens.fy_px * yd + lens.cy_px;
  vertex.texture_u_w = static_cast<float>((u_px + 0.5) / width_px * w);
  vertex.texture_v_w = static_cast<float>((v_px + 0.5) / height_px * w);
  vertex.texture_w = static_cast<float>(w);
  return sideBits(u_px, v_px, width_px, height_px);
}

/// What the soft edge takes from the cells. The picture's outline is a polygon. A cell with all
/// corners outside it shows nothing, except if the polygon has a corner of its own in there.
void WarpMesh::mask(const hal::EdgeMask& edge) {
  for (std::uint32_t j = first_row_; j <= last_row_; ++j) {
    for (std::uint32_t i = first_column_; i <= last_column_; ++i) {
      const double out =
          edge.at((columnPx(i) + 0.5) / width_px_ * 2 - 1, (rowPx(j) + 0.5) / height_px_ * 2 - 1);
      std::uint16_t& where = where_[std::size_t{j} * columns_ + i];
      if (out > hal::EdgeMask::kNone) where |= kSoftened;
      if (out >= 1) where |= kMaskedOut;
    }
  }
  for (std::size_t place = 0; place < hal::EdgeMask::kPlaces; ++place) {
    const auto [u, v] = hal::EdgeMask::pointOf(place);
    const double reach = 1 / double{edge.narrowing[place]};
    const auto i = static_cast<std::int64_t>((u * reach + 1) / 2 * width_px_ / kCellPx);
    const auto j = static_cast<std::int64_t>((v * reach + 1) / 2 * height_px_ / kCellPx);
    if (i < first_column_ || i >= last_column_ || j < first_row_ || j >= last_row_) continue;
    where_[static_cast<std::size_t>(j) * columns_ + static_cast<std::size_t>(i)] |= kMaskBends;
  }
}

WarpMesh::Cell WarpMesh::classify(std::size_t first) const {
  const std::array corners = {where_[first], where_[first + 1], where_[first + columns_],
                              where_[first + columns_ + 1]};
  std::uint16_t all = 0xFFFF;
  std::uint16_t any = 0;
  for (const std::uint16_t corner : corners) {
    all &= corner;
    any |= corner & ~kMaskBends;
  }
  constexpr std::uint16_t kCertain = kBehind | kLeft | kRight | kAbove | kBelow;
  if (any == 0) return Cell::kInner;
  if ((all & kCertain) != 0) return Cell::kOutside;
  if ((all & kMaskedOut) != 0 && (corners[0] & kMaskBends) == 0) return Cell::kOutside;
  return (any & ~(kSoftened | kMaskedOut)) == 0 ? Cell::kSoft : Cell::kEdge;
}

std::vector<std::uint16_t>* WarpMesh::indicesFor(Cell cell) {
  switch (cell) {
    case Cell::kInner:
      return &inner_;
    case Cell::kSoft:
      return &soft_;
    case Cell::kEdge:
      return &edge_;
    case Cell::kOutside:
      break;
  }
  return nullptr;
}

void WarpMesh::choose(const hal::RectPx& where) {
  const auto cell = [](std::int32_t px) { return static_cast<std::uint32_t>(px) / kCellPx; };
  first_column_ = cell(where.x);
  first_row_ = cell(where.y);
  last_column_ = cell(where.x + where.width - 1) + 1;
  last_row_ = cell(where.y + where.height - 1) + 1;
}

void WarpMesh::update(const hal::WarpPlan& plan, const hal::RectPx& where) {
  for (auto* indices : {&inner_, &soft_, &edge_}) indices->clear();
  const auto drawn = common(
      where, {0, 0, static_cast<std::int32_t>(width_px_), static_cast<std::int32_t>(height_px_)});
  if (drawn.empty()) return;
  choose(drawn);
  updateVertices(plan);
  for (std::uint32_t j = first_row_; j < last_row_; ++j) {
    for (std::uint32_t i = first_column_; i < last_column_; ++i) {
      const std::size_t first = std::size_t{j} * columns_ + i;
      auto* const indices = indicesFor(classify(first));
      if (indices == nullptr) continue;
      const auto a = static_cast<std::uint16_t>(first);
      const auto b = static_cast<std::uint16_t>(first + 1);
      const auto c = static_cast<std::uint16_t>(first + columns_);
      const auto d = static_cast<std::uint16_t>(first + columns_ + 1);
      indices->insert(indices->end(), {a, b, c, b, d, c});
    }
  }
}

}  // namespace ui

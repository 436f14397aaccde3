#pragma once

#include <cstdint>
#include <vector>

#include "hal/scene.h"

namespace ui {

/// One corner of the mesh; position is fixed by the index.
struct WarpVertex {
  /// Source texture coordinate times w, and w: linear over the display as the rasteriser needs it.
  float texture_u_w = 0, texture_v_w = 0, texture_w = 0;
  /// H_camera_display times the display pixel: undistorted, homogeneous, pixels.
  float ray_x = 0, ray_y = 0, ray_w = 0;
};

/// The backward map of one plan over a coarse grid of the picture.
///
/// A cell wholly inside lens and source is `inner`: the distortion is evaluated at its corners and
/// interpolated in camera space, so perspective is exact. A `soft` cell is an inner cell with a
/// part of the soft edge. A cell that the source's border may cross is `edge`: a shader evaluates
/// it per pixel. A cell that certainly shows nothing is in none of them.
///
/// The valid region (w > 0 and radius <= max_radius) is the preimage of a disc under a homography
/// and therefore convex: four valid corners make a valid cell.
///
/// Memory   All storage is made by the constructor.
class WarpMesh {
 public:
  static constexpr std::uint32_t kCellPx = 32;

  WarpMesh(std::uint32_t width_px, std::uint32_t height_px);

  /// For the cells that touch @p where.
  void update(const hal::WarpPlan& plan, const hal::RectPx& where = hal::kWholePicture);

  [[nodiscard]] const std::vector<WarpVertex>& vertices() const { return vertices_; }
  /// Six indices, two triangles, per cell.
  [[nodiscard]] const std::vector<std::uint16_t>& innerIndices() const { return inner_; }
  [[nodiscard]] const std::vector<std::uint16_t>& softIndices() const { return soft_; }
  [[nodiscard]] const std::vector<std::uint16_t>& edgeIndices() const { return edge_; }
  /// Column @p i's left border in display pixels: -0.5 is the picture's edge.
  [[nodiscard]] double columnPx(std::uint32_t i) const;
  [[nodiscard]] double rowPx(std::uint32_t j) const;
  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  /// Of corners that update() worked out; the others are from before.
  [[nodiscard]] std::uint32_t firstRow() const { return first_row_; }
  [[nodiscard]] std::uint32_t lastRow() const { return last_row_; }

 private:
  enum class Cell : std::uint8_t { kInner, kSoft, kEdge, kOutside };
  void choose(const hal::RectPx& where);
  void updateVertices(const hal::WarpPlan& plan);
  [[nodiscard]] std::uint16_t place(const hal::WarpPlan& plan, double x_px, double y_px,
                                    WarpVertex& vertex) const;
  void mask(const hal::EdgeMask& edge);
  [[nodiscard]] std::vector<std::uint16_t>* indicesFor(Cell cell);
  [[nodiscard]] Cell classify(std::size_t first) const;

  std::uint32_t width_px_;
  std::uint32_t height_px_;
  std::uint32_t columns_;  // of corners: one more than cells
  std::uint32_t rows_;
  // Corners in use, the last ones included.
  std::uint32_t first_column_ = 0, last_column_ = 0;
  std::uint32_t first_row_ = 0, last_row_ = 0;
  std::vector<WarpVertex> vertices_;
  std::vector<std::uint16_t> where_;  // per corner: bits of warp_mesh.cpp
  std::vector<std::uint16_t> inner_;
  std::vector<std::uint16_t> soft_;
  std::vector<std::uint16_t> edge_;
};

}  // namespace ui

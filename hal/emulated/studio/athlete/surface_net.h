#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hal/emulated/studio/athlete/distance.h"

namespace emulator::studio {

using Field = std::function<float(const Point&)>;

/// Grid lines of one axis; cells may differ in size along it.
using GridLines = std::vector<float>;

/// A stretch of an axis in which cells have at most this size.
struct FineRange {
  float from, to, cell_m;
};

/// Lines from @p from to @p to, cells of @p cell_m, finer inside @p fine. Sizes change by at most
/// a fifth from cell to cell, so that triangles stay well shaped.
[[nodiscard]] GridLines gridLines(float from, float to, float cell_m,
                                  const std::vector<FineRange>& fine);

struct Polygons {
  std::vector<Point> positions;
  std::vector<Point> normals;            ///< unit, outwards
  std::vector<std::uint32_t> triangles;  ///< counter-clockwise seen from outside
};

/// Where @p field is zero, as one closed surface: naive surface nets (Gibson 1998), then every
/// vertex is moved onto the surface along the gradient, which also gives its normal. Blocks whose
/// centre is farther from the surface than they reach are skipped: the field must not exceed
/// 1.5 times the true distance. The surface must not touch the grid's border.
[[nodiscard]] Polygons polygonise(const Field& field, const GridLines& x, const GridLines& y,
                                  const GridLines& z);

}  // namespace emulator::studio

#include "appliance/depth/depth_sight.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace appliance {
namespace {

constexpr std::uint32_t kStep_px = 8;
constexpr std::uint32_t kPatch_px = 16;  // half of its side

/// The pixels around the middle of @p size, the end not included.
struct Range {
  std::uint32_t begin;
  std::uint32_t end;
};
Range middleOf(std::uint32_t size) {
  const std::uint32_t middle = size / 2;
  return {.begin = middle - std::min(middle, kPatch_px), .end = std::min(size, middle + kPatch_px)};
}

}  // namespace

DepthSight sightOf(std::span<const std::uint16_t> depth_mm, std::uint32_t width_px,
                   std::uint32_t height_px) {
  DepthSight sight;
  if (depth_mm.size() < std::size_t{width_px} * height_px) return sight;
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return depth_mm[std::size_t{y} * width_px + x];
  };
  std::size_t looked = 0;
  std::size_t measured = 0;
  for (std::uint32_t y = 0; y < height_px; y += kStep_px) {
    for (std::uint32_t x = 0; x < width_px; x += kStep_px) {
      ++looked;
      if (at(x, y) != 0) ++measured;
    }
  }
  if (looked > 0)
    sight.measured_share = static_cast<double>(measured) / static_cast<double>(looked);

  std::vector<std::uint16_t> around;
  const Range rows = middleOf(height_px);
  const Range columns = middleOf(width_px);
  for (std::uint32_t y = rows.begin; y < rows.end; ++y)
    for (std::uint32_t x = columns.begin; x < columns.end; ++x)
      if (at(x, y) != 0) around.push_back(at(x, y));
  if (around.empty()) return sight;
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
  std::ranges::nth_element(around, middle);
  sight.middle_m = *middle * 1e-3;
  return sight;
}

}  // namespace appliance

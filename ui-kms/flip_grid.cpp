#include "ui-kms/flip_grid.h"

#include <cassert>
#include <cmath>

namespace ui {

FlipGrid::FlipGrid(rt::Timestamp epoch, double refresh_hz)
    : epoch_(epoch), period_ns_(1e9 / refresh_hz) {
  assert(refresh_hz > 0);
}

rt::Timestamp FlipGrid::at(std::uint64_t vblank) const {
  return epoch_ + rt::Nanoseconds(std::llround(static_cast<double>(vblank) * period_ns_));
}

std::uint64_t FlipGrid::firstAfter(rt::Timestamp t) const {
  if (t < epoch_) return 0;
  const auto since_ns = static_cast<double>((t - epoch_).count());
  auto vblank = static_cast<std::uint64_t>(since_ns / period_ns_);
  while (at(vblank) <= t) ++vblank;  // the division may fall on either side of a vblank
  while (vblank > 0 && at(vblank - 1) > t) --vblank;
  return vblank;
}

}  // namespace ui

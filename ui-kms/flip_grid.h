#pragma once

#include <cstdint>

#include "rt/clock.h"

namespace ui {

/// The vblanks of an emulated screen: an absolute grid, so that nothing drifts.
/// Pure: time is an argument.
class FlipGrid {
 public:
  /// Vblank 0 is at @p epoch. @p refresh_hz is positive.
  FlipGrid(rt::Timestamp epoch, double refresh_hz);

  [[nodiscard]] rt::Timestamp at(std::uint64_t vblank) const;
  /// The first vblank strictly after @p t; 0 for instants before the epoch.
  [[nodiscard]] std::uint64_t firstAfter(rt::Timestamp t) const;

 private:
  rt::Timestamp epoch_;
  double period_ns_;
};

}  // namespace ui

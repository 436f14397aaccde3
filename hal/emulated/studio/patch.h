#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace emulator::studio {

/// What differs in one camera's picture of a moment from the empty hall: runs of sensor pixels.
struct Patch {
  struct Run {
    std::uint32_t start = 0;  ///< row times width plus column
    std::uint32_t length = 0;
  };
  std::vector<Run> runs;
  std::vector<std::uint8_t> pixels;  ///< of all runs, one after the other

  /// Writes the runs into a whole picture.
  void putInto(std::span<std::uint8_t> picture) const;
  /// Writes what @p original has at the runs' places.
  void takeOutOf(std::span<std::uint8_t> picture, std::span<const std::uint8_t> original) const;
};

}  // namespace emulator::studio

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace emulator {

/// Neighbouring pixels of one row.
struct PixelRun {
  std::uint32_t start = 0;  ///< row times width plus column
  std::uint32_t length = 0;
  std::uint32_t from = 0;  ///< pixels of all runs before it
};

/// Pixels that replace some of a picture's. Pure.
/// Memory   Borrowed.
struct Overlay {
  std::span<const PixelRun> runs;        ///< ascending, apart from each other
  std::span<const std::uint8_t> pixels;  ///< of all runs, one after the other

  /// Whether one of the @p count pixels from @p first on is replaced.
  [[nodiscard]] bool touches(std::size_t first, std::size_t count) const;
  /// Replaces pixels of a picture's part that begins at its pixel @p first.
  void putInto(std::span<std::uint8_t> part, std::size_t first) const;

 private:
  /// The first run that ends behind @p pixel.
  [[nodiscard]] std::span<const PixelRun>::iterator endingBehind(std::size_t pixel) const;
};

}  // namespace emulator

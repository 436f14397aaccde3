#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace emulator::studio {

/// Neighbouring pixels of one row that differ from the empty hall.
struct Run {
  std::uint32_t start = 0;  ///< row times width plus column
  std::uint32_t length = 0;
};

/// Puts changed pixels together to runs. Of two runs in one row with a short gap between them it
/// makes one: the gap's pixels cost less than another run.
class RunMaker {
 public:
  explicit RunMaker(std::vector<Run>& runs) : runs_(runs) {}

  void beginRow() { open_ = false; }
  /// The next changed pixel, in ascending order. Of how many unchanged pixels just before it the
  /// values are wanted, too.
  [[nodiscard]] std::uint32_t add(std::uint32_t pixel);

 private:
  std::vector<Run>& runs_;
  bool open_ = false;
};

/// Whether the runs lie in a picture of @p pixels and are @p length together.
[[nodiscard]] bool fit(std::span<const Run> runs, std::size_t pixels, std::size_t length);

/// What differs in one camera's picture of a moment from the empty hall: runs of sensor pixels.
struct Patch {
  std::vector<Run> runs;
  std::vector<std::uint8_t> pixels;  ///< of all runs, one after the other

  /// Writes the runs into a whole picture.
  void putInto(std::span<std::uint8_t> picture) const;
  /// Writes what @p original has at the runs' places.
  void takeOutOf(std::span<std::uint8_t> picture, std::span<const std::uint8_t> original) const;
};

}  // namespace emulator::studio

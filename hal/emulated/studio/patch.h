#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/emulated/rig/overlay.h"

namespace emulator::studio {

/// Puts changed pixels together to runs. Of two runs in one row with a short gap between them it
/// makes one: the gap's pixels cost less than another run.
class RunMaker {
 public:
  explicit RunMaker(std::vector<PixelRun>& runs) : runs_(runs) {}

  void beginRow() { open_ = false; }
  /// The next changed pixel, in ascending order. Of how many unchanged pixels just before it the
  /// values are wanted, too.
  [[nodiscard]] std::uint32_t add(std::uint32_t pixel);

 private:
  std::vector<PixelRun>& runs_;
  bool open_ = false;
};

/// Whether the runs lie in a picture of @p pixels, one behind the other, and are @p length
/// together.
[[nodiscard]] bool fit(std::span<const PixelRun> runs, std::size_t pixels, std::size_t length);

/// What differs in one camera's picture of a moment from the empty hall: runs of sensor pixels.
struct Patch {
  std::vector<PixelRun> runs;
  std::vector<std::uint8_t> pixels;  ///< of all runs, one after the other

  [[nodiscard]] Overlay overlay() const { return {.runs = runs, .pixels = pixels}; }
};

/// One moment as all cameras see it.
using MomentPatches = std::vector<Patch>;

}  // namespace emulator::studio

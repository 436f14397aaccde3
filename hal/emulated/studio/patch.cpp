#include "hal/emulated/studio/patch.h"

#include <cstring>

namespace emulator::studio {
namespace {

/// A gap of unchanged pixels shorter than this costs less than another run.
constexpr std::uint32_t kShortGap = 12;

}  // namespace

std::uint32_t RunMaker::add(std::uint32_t pixel) {
  if (open_) {
    Run& last = runs_.back();
    const std::uint32_t gap = pixel - (last.start + last.length);
    if (gap < kShortGap) {
      last.length += gap + 1;
      return gap;
    }
  }
  runs_.push_back({.start = pixel, .length = 1});
  open_ = true;
  return 0;
}

bool fit(std::span<const Run> runs, std::size_t pixels, std::size_t length) {
  std::uint64_t sum = 0;
  for (const Run& run : runs) {
    if (std::uint64_t{run.start} + run.length > pixels) return false;
    sum += run.length;
  }
  return sum == length;
}

void Patch::putInto(std::span<std::uint8_t> picture) const {
  const std::uint8_t* from = pixels.data();
  for (const Run& run : runs) {
    std::memcpy(&picture[run.start], from, run.length);
    from += run.length;
  }
}

void Patch::takeOutOf(std::span<std::uint8_t> picture,
                      std::span<const std::uint8_t> original) const {
  for (const Run& run : runs) std::memcpy(&picture[run.start], &original[run.start], run.length);
}

}  // namespace emulator::studio

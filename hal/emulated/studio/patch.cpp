#include "hal/emulated/studio/patch.h"

namespace emulator::studio {
namespace {

/// A gap of unchanged pixels shorter than this costs less than another run.
constexpr std::uint32_t kShortGap = 12;

}  // namespace

std::uint32_t RunMaker::add(std::uint32_t pixel) {
  if (open_) {
    PixelRun& last = runs_.back();
    const std::uint32_t gap = pixel - (last.start + last.length);
    if (gap < kShortGap) {
      last.length += gap + 1;
      return gap;
    }
  }
  const std::uint32_t from = runs_.empty() ? 0 : runs_.back().from + runs_.back().length;
  runs_.push_back({.start = pixel, .length = 1, .from = from});
  open_ = true;
  return 0;
}

bool fit(std::span<const PixelRun> runs, std::size_t pixels, std::size_t length) {
  std::uint64_t sum = 0;
  std::uint64_t end = 0;
  for (const PixelRun& run : runs) {
    if (run.start < end || run.from != sum) return false;
    end = std::uint64_t{run.start} + run.length;
    sum += run.length;
  }
  return end <= pixels && sum == length;
}

}  // namespace emulator::studio

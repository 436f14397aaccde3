#include "hal/emulated/rig/overlay.h"

#include <algorithm>
#include <cstring>

namespace emulator {

std::span<const PixelRun>::iterator Overlay::endingBehind(std::size_t pixel) const {
  return std::ranges::partition_point(
      runs, [&](const PixelRun& run) { return std::size_t{run.start} + run.length <= pixel; });
}

bool Overlay::touches(std::size_t first, std::size_t count) const {
  const auto run = endingBehind(first);
  return run != runs.end() && run->start < first + count;
}

void Overlay::putInto(std::span<std::uint8_t> part, std::size_t first) const {
  const std::size_t end = first + part.size();
  for (auto run = endingBehind(first); run != runs.end() && run->start < end; ++run) {
    const std::size_t low = std::max<std::size_t>(run->start, first);
    const std::size_t high = std::min<std::size_t>(std::size_t{run->start} + run->length, end);
    std::memcpy(&part[low - first], &pixels[run->from + (low - run->start)], high - low);
  }
}

}  // namespace emulator

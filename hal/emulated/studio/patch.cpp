#include "hal/emulated/studio/patch.h"

#include <cstring>

namespace emulator::studio {

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

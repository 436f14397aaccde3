#include "hal/emulated/studio/moment_file.h"

#include <array>

#include "hal/emulated/studio/bytes.h"

namespace emulator::studio {

std::vector<std::byte> writeMoments(std::span<const MomentPatches> moments) {
  std::vector<std::byte> bytes;
  for (const auto& patches : moments) {
    for (const Patch& patch : patches) {
      const std::array counts = {static_cast<std::uint32_t>(patch.runs.size()),
                                 static_cast<std::uint32_t>(patch.pixels.size())};
      putBytes(bytes, counts);
      putBytes(bytes, patch.runs);
      putBytes(bytes, patch.pixels);
    }
  }
  return bytes;
}

std::optional<std::vector<MomentPatches>> readMoments(std::span<const std::byte> bytes,
                                                      std::uint32_t count, std::uint32_t cameras,
                                                      SizePx size) {
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  std::vector<MomentPatches> moments(count, MomentPatches(cameras));
  for (auto& patches : moments) {
    for (Patch& patch : patches) {
      std::array<std::uint32_t, 2> counts{};
      if (!takeBytes(bytes, counts) || counts[0] > pixels || counts[1] > pixels)
        return std::nullopt;
      patch.runs.resize(counts[0]);
      patch.pixels.resize(counts[1]);
      if (!takeBytes(bytes, patch.runs) || !takeBytes(bytes, patch.pixels) ||
          !fit(patch.runs, pixels, patch.pixels.size()))
        return std::nullopt;
    }
  }
  if (!bytes.empty()) return std::nullopt;
  return moments;
}

}  // namespace emulator::studio

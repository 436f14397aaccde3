#include "hal/emulated/studio/moment_file.h"

#include <cstring>

namespace emulator::studio {

std::vector<std::byte> writeMoments(std::span<const std::vector<Patch>> moments) {
  std::vector<std::byte> bytes;
  const auto put = [&bytes](const void* from, std::size_t size) {
    const std::size_t at = bytes.size();
    bytes.resize(at + size);
    if (size > 0) std::memcpy(&bytes[at], from, size);
  };
  for (const auto& patches : moments) {
    for (const Patch& patch : patches) {
      const std::uint32_t counts[2] = {static_cast<std::uint32_t>(patch.runs.size()),
                                       static_cast<std::uint32_t>(patch.pixels.size())};
      put(counts, sizeof counts);
      put(patch.runs.data(), patch.runs.size() * sizeof(Patch::Run));
      put(patch.pixels.data(), patch.pixels.size());
    }
  }
  return bytes;
}

std::optional<std::vector<std::vector<Patch>>> readMoments(std::span<const std::byte> bytes,
                                                           std::uint32_t count,
                                                           std::uint32_t cameras, SizePx size) {
  const auto take = [&bytes](void* to, std::size_t wanted) {
    if (bytes.size() < wanted) return false;
    if (wanted > 0) std::memcpy(to, bytes.data(), wanted);
    bytes = bytes.subspan(wanted);
    return true;
  };
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  std::vector<std::vector<Patch>> moments(count, std::vector<Patch>(cameras));
  for (auto& patches : moments) {
    for (Patch& patch : patches) {
      std::uint32_t counts[2];
      if (!take(counts, sizeof counts) || counts[0] > pixels || counts[1] > pixels)
        return std::nullopt;
      patch.runs.resize(counts[0]);
      patch.pixels.resize(counts[1]);
      if (!take(patch.runs.data(), patch.runs.size() * sizeof(Patch::Run)) ||
          !take(patch.pixels.data(), patch.pixels.size()))
        return std::nullopt;
      std::uint64_t sum = 0;
      for (const Patch::Run& run : patch.runs) {
        if (std::uint64_t{run.start} + run.length > pixels) return std::nullopt;
        sum += run.length;
      }
      if (sum != patch.pixels.size()) return std::nullopt;
    }
  }
  if (!bytes.empty()) return std::nullopt;
  return moments;
}

}  // namespace emulator::studio

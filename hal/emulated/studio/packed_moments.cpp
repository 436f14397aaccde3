#include "hal/emulated/studio/packed_moments.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace emulator::studio {
namespace {

constexpr std::size_t kCacheLine = 64;

std::size_t bytesOf(const auto& values) {
  return (std::as_bytes(std::span(values)).size() + kCacheLine - 1) / kCacheLine * kCacheLine;
}

/// Copies @p values to the beginning of @p rest, which it takes from it.
template <typename T>
std::span<const T> put(const std::vector<T>& values, std::span<std::byte>& rest) {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kCacheLine);
  const auto copy = rest.first(bytesOf(values));
  rest = rest.subspan(copy.size());
  if (!values.empty()) std::memcpy(copy.data(), values.data(), values.size() * sizeof(T));
  return {reinterpret_cast<const T*>(copy.data()), values.size()};
}

}  // namespace

rt::Result<PackedMoments> packMoments(std::span<const MomentPatches> moments) {
  std::size_t bytes = 0;
  for (const MomentPatches& moment : moments)
    for (const Patch& patch : moment) bytes += bytesOf(patch.runs) + bytesOf(patch.pixels);

  auto memory = rt::LockedArena::create(std::max<std::size_t>(bytes, 1));
  if (!memory) return std::unexpected(memory.error());
  PackedMoments packed{.memory = std::move(*memory), .overlays = {}};
  std::span<std::byte> rest = packed.memory.bytes();
  for (const MomentPatches& moment : moments) {
    auto& overlays = packed.overlays.emplace_back();
    for (const Patch& patch : moment) {
      const auto runs = put(patch.runs, rest);
      overlays.push_back({.runs = runs, .pixels = put(patch.pixels, rest)});
    }
  }
  return packed;
}

}  // namespace emulator::studio

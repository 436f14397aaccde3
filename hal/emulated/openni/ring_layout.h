#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "hal/emulated/openni/ring.h"

namespace emulator {

/// The bytes of a ring's file: this head, then per slot the depth and, with colour, the colour.
struct DepthRingHead {
  static constexpr std::array<char, 8> kMagic = {'k', 'g', 'm', 'd', 'e', 'p', 't', 'h'};
  static constexpr std::uint32_t kVersion = 1;

  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t slots;
  RgbdFormat format;
  std::atomic<std::uint32_t> plugged;
  std::atomic<std::uint32_t> bell;  ///< a futex: changes with every picture
  std::atomic<std::uint64_t> newest;

  struct Slot {
    std::atomic<std::uint64_t> number;  ///< 0 while it is drawn
    std::atomic<std::int64_t> exposure_ns;
  };
  std::array<Slot, DepthRingWriter::kSlots> slot;
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

inline constexpr std::size_t kDepthRingHeadBytes = 4096;
static_assert(sizeof(DepthRingHead) <= kDepthRingHeadBytes);

[[nodiscard]] inline std::size_t depthBytes(const RgbdFormat& format) {
  return format.pixels() * sizeof(float);
}
/// A slot begins on a page, whatever the size of the pictures.
[[nodiscard]] inline std::size_t slotBytes(const RgbdFormat& format) {
  const std::size_t bytes = depthBytes(format) + (format.colour ? format.pixels() * 3 : 0);
  return (bytes + 4095) / 4096 * 4096;
}
[[nodiscard]] inline std::size_t ringBytes(const RgbdFormat& format) {
  return kDepthRingHeadBytes + DepthRingWriter::kSlots * slotBytes(format);
}

}  // namespace emulator

#pragma once

#include <cstdint>

/// Big-endian words, as GVCP and GVSP carry them. The caller guarantees the bytes are there.
namespace emulator {

[[nodiscard]] constexpr std::uint16_t loadBe16(const std::uint8_t* p) {
  return static_cast<std::uint16_t>(p[0] << 8 | p[1]);
}
[[nodiscard]] constexpr std::uint32_t loadBe32(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(loadBe16(p)) << 16 | loadBe16(p + 2);
}
constexpr void storeBe16(std::uint8_t* p, std::uint16_t v) {
  p[0] = static_cast<std::uint8_t>(v >> 8);
  p[1] = static_cast<std::uint8_t>(v);
}
constexpr void storeBe32(std::uint8_t* p, std::uint32_t v) {
  storeBe16(p, static_cast<std::uint16_t>(v >> 16));
  storeBe16(p + 2, static_cast<std::uint16_t>(v));
}

}  // namespace emulator

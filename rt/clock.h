#pragma once

#include <chrono>
#include <cstdint>

namespace rt {

using Nanoseconds = std::chrono::nanoseconds;

/// An instant on CLOCK_MONOTONIC, the only clock of the product: steady_clock is
/// that clock on Linux with glibc. The epoch (zero) stands for "did not happen".
using Timestamp = std::chrono::time_point<std::chrono::steady_clock, Nanoseconds>;

/// RT safe: a vDSO read, no system call.
[[nodiscard]] inline Timestamp now() noexcept {
  return std::chrono::steady_clock::now();
}

[[nodiscard]] constexpr std::int64_t toNs(Timestamp t) noexcept {
  return t.time_since_epoch().count();
}
[[nodiscard]] constexpr Timestamp fromNs(std::int64_t t_ns) noexcept {
  return Timestamp{Nanoseconds{t_ns}};
}

}  // namespace rt

#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace emulator::studio {

/// A vector's or an array's @p values as they lie in memory, behind what @p to has: the cache is
/// read by its own machine.
template <class Values>
void putBytes(std::vector<std::byte>& to, const Values& values) {
  const auto bytes = std::as_bytes(std::span(values));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// Fills @p values from the front of @p bytes, which it takes off; false where they are too few.
template <class Values>
[[nodiscard]] bool takeBytes(std::span<const std::byte>& bytes, Values& values) {
  const auto wanted = std::as_writable_bytes(std::span(values));
  if (bytes.size() < wanted.size()) return false;
  if (!wanted.empty()) std::memcpy(wanted.data(), bytes.data(), wanted.size());
  bytes = bytes.subspan(wanted.size());
  return true;
}

}  // namespace emulator::studio

#pragma once

#include <cstdint>
#include <expected>

namespace rt {

/// What the world can do to us; our own bugs are assertions instead.
enum class Errc : std::uint8_t {
  kDeviceLost = 1,
  kBusy,
  kUnsupported,
  kInvalidConfig,
  kNoMemory,
  kNotPermitted,
};

/// An outcome that real-time code may return: no allocation, no formatting.
/// @p where names the operation for the one line that a person reads.
struct Error {
  Errc code;
  int os_errno = 0;
  const char* where = "";
};

template <class T>
using Result = std::expected<T, Error>;

}  // namespace rt

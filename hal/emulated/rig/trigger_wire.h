#pragma once

#include <optional>
#include <string_view>

#include "rt/clock.h"

namespace emulator {

/// One edge of Line1 as it stands on the wire: "L1+ <monotonic_ns>" or "L1- <monotonic_ns>".
struct WireEdge {
  bool rising = false;
  rt::Timestamp at;
  friend bool operator==(const WireEdge&, const WireEdge&) = default;
};

/// Nothing when the text is not an edge.
[[nodiscard]] std::optional<WireEdge> parseWireEdge(std::string_view datagram);

/// An edge's stamp lies within this span around its arrival, or sender and emulator do not
/// share a clock.
inline constexpr rt::Nanoseconds kLongestWireDelay = std::chrono::seconds(1);

}  // namespace emulator

#include "hal/emulated/rig/trigger_wire.h"

#include <charconv>

namespace emulator {

std::optional<WireEdge> parseWireEdge(std::string_view datagram) {
  while (!datagram.empty() && (datagram.back() == '\n' || datagram.back() == '\0')) {
    datagram.remove_suffix(1);
  }
  if (!datagram.starts_with("L1+ ") && !datagram.starts_with("L1- ")) return std::nullopt;
  const bool rising = datagram[2] == '+';
  datagram.remove_prefix(4);
  std::int64_t at_ns = 0;
  const auto [end, error] = std::from_chars(datagram.begin(), datagram.end(), at_ns);
  if (error != std::errc{} || end != datagram.end() || at_ns < 0) return std::nullopt;
  return WireEdge{rising, rt::fromNs(at_ns)};
}

}  // namespace emulator

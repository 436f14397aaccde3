#include "appliance/capture/association.h"

namespace appliance {
namespace {

// A frame is looked for among this many newest triggers: more than a frame's whole way
// (exposure, transfer, resends) can take.
constexpr std::uint64_t kReach = 32;

}  // namespace

std::optional<std::uint64_t> Association::edgeNear(rt::Timestamp fired, rt::Nanoseconds within,
                                                   const EdgeBoard& edges) RT_SAFE {
  const std::uint64_t newest = edges.newest();
  for (std::uint64_t back = 0; back < kReach && back < newest; ++back) {
    const std::uint64_t trigger = newest - back;
    const rt::Timestamp edge = edges.edge(trigger);
    if (edge == rt::Timestamp{}) return std::nullopt;
    if (std::chrono::abs(fired - edge) < within) return trigger;
    if (edge < fired) return std::nullopt;  // older edges are only further away
  }
  return std::nullopt;
}

std::optional<std::uint64_t> Association::triggerOf(rt::Timestamp arrival,
                                                    const EdgeBoard& edges) const RT_SAFE {
  // Exactly between two edges is nobody's.
  return edgeNear(arrival - camera_delay_, period_ / 2, edges);
}

}  // namespace appliance

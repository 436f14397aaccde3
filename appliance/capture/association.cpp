#include "appliance/capture/association.h"

namespace appliance {
namespace {

// The newest triggers that are considered: a frame's exposure, transfer and resends take less.
constexpr std::uint64_t kReach = 32;

/// The newest trigger whose edge lies less than within(trigger) from @p fired.
template <class Within>
std::optional<std::uint64_t> find(rt::Timestamp fired, const EdgeBoard& edges,
                                  Within within) RT_SAFE {
  const std::uint64_t newest = edges.newest();
  for (std::uint64_t back = 0; back < kReach && back < newest; ++back) {
    const std::uint64_t trigger = newest - back;
    const rt::Timestamp edge = edges.edge(trigger);
    if (edge == rt::Timestamp{}) return std::nullopt;
    const rt::Nanoseconds near = within(trigger);
    if (std::chrono::abs(fired - edge) < near) return trigger;
    if (edge + near < fired) return std::nullopt;  // older edges are only further away
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> Association::edgeNear(rt::Timestamp fired, rt::Nanoseconds within,
                                                   const EdgeBoard& edges) RT_SAFE {
  return find(fired, edges, [within](std::uint64_t /*trigger*/) { return within; });
}

std::optional<std::uint64_t> Association::edgeMaybeNear(rt::Timestamp fired, rt::Nanoseconds within,
                                                        const EdgeBoard& edges) RT_SAFE {
  return find(fired, edges,
              [&](std::uint64_t trigger) { return within + edges.uncertainty(trigger); });
}

std::optional<std::uint64_t> Association::triggerOf(rt::Timestamp arrival,
                                                    const EdgeBoard& edges) const RT_SAFE {
  // Exactly between two edges it belongs to neither.
  return edgeNear(arrival - camera_delay_, period_ / 2, edges);
}

}  // namespace appliance

#pragma once

#include <cstdint>
#include <optional>

#include "rt/clock.h"

namespace emulator {

/// One exposure, from the edge that asked for it.
struct Exposure {
  std::uint64_t trigger = 0;
  rt::Timestamp edge;
  rt::Timestamp start;
  rt::Timestamp end;  ///< readout and sending begin here
};

struct ExposureTiming {
  rt::Nanoseconds trigger_delay{0};
  rt::Nanoseconds exposure{0};
};

/// Decides whether a sensor without a frame buffer can follow an edge: not while it exposes,
/// and not when the new frame would have to be read out before the link is free. Pure.
/// @p link_free_at  when the frame being sent will have left; the epoch when none is.
[[nodiscard]] std::optional<Exposure> tryExpose(std::uint64_t trigger, rt::Timestamp edge,
                                                const ExposureTiming& timing, bool exposing,
                                                rt::Timestamp link_free_at);

}  // namespace emulator

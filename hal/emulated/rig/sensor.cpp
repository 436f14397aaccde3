#include "hal/emulated/rig/sensor.h"

namespace emulator {

std::optional<Exposure> tryExpose(std::uint64_t trigger, rt::Timestamp edge,
                                  const ExposureTiming& timing, bool exposing,
                                  rt::Timestamp link_free_at) {
  if (exposing) return std::nullopt;
  const Exposure exposure{trigger, edge, edge + timing.trigger_delay,
                          edge + timing.trigger_delay + timing.exposure};
  if (exposure.end < link_free_at) return std::nullopt;
  return exposure;
}

}  // namespace emulator

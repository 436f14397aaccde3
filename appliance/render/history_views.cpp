#include "appliance/render/history_views.h"

#include "appliance/capture/liveness.h"

namespace appliance {

StoredRange HistoryViews::range(std::uint32_t camera) const RT_SAFE {
  const CameraFrames& frames = history_.camera(camera);
  return {.oldest = frames.oldest(), .newest = frames.newest()};
}

bool HistoryViews::holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE {
  return history_.camera(camera).holds(trigger);
}

bool HistoryViews::living(std::uint32_t camera) const RT_SAFE {
  return delivers(history_.camera(camera).newest(), edges_.newest());
}

}  // namespace appliance

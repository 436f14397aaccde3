#include "appliance/render/history_views.h"

#include "appliance/capture/liveness.h"

namespace appliance {

StoredRange HistoryViews::range(std::uint32_t camera) const RT_SAFE {
  const CameraFrames& frames = history().camera(camera);
  return {.oldest = frames.oldest(), .newest = frames.newest()};
}

bool HistoryViews::holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE {
  return history().camera(camera).holds(trigger);
}

bool HistoryViews::living(std::uint32_t camera) const RT_SAFE {
  return delivers(history().camera(camera).newest(), edges_.newest());
}

std::optional<PinnedFrame> HistoryViews::tryPin(std::uint32_t camera,
                                                std::uint64_t trigger) RT_SAFE {
  return reader_.tryPin(camera, trigger);
}

}  // namespace appliance

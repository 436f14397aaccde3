#pragma once

#include <cstdint>
#include <optional>

#include "appliance/capture/camera_frames.h"
#include "appliance/director/stored_views.h"
#include "rt/annotations.h"

namespace appliance {

/// Everything that is stored of the rig, as the render loop sees it: what the director decides by,
/// and the frames themselves. Which memory holds a frame is the implementation's business.
///
/// Threads  The render thread.
/// RT       Every member is RT safe.
class StoredFrames : public StoredViews {
 public:
  /// The frame of that trigger, which stays in place while the result lives; nothing if it is not
  /// stored (any more), or beyond the reader's budget.
  [[nodiscard]] virtual std::optional<PinnedFrame> tryPin(std::uint32_t camera,
                                                          std::uint64_t trigger) RT_SAFE = 0;
};

}  // namespace appliance

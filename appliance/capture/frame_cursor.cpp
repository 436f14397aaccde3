#include "appliance/capture/frame_cursor.h"

#include <algorithm>

#include "appliance/capture/frame_history.h"

namespace appliance {

std::optional<PinnedFrame> FrameCursor::tryNext() RT_SAFE {
  const CameraFrames& frames = reader_.history().camera(camera_);
  const std::uint64_t newest = frames.newest();
  if (newest == 0) return std::nullopt;
  const std::uint64_t first =
      last_trigger_ == 0 ? newest : std::max(last_trigger_ + 1, frames.oldest());
  for (std::uint64_t trigger = first; trigger <= newest; ++trigger) {
    if (!frames.holds(trigger)) continue;  // the camera had no frame, or it is overtaken already
    auto frame = reader_.tryPin(camera_, trigger);
    if (!frame && frames.holds(trigger)) return std::nullopt;  // beyond the budget
    if (!frame) continue;                                      // overtaken just now
    if (last_trigger_ != 0) too_slow_for_ += frame->frame.number - last_number_ - 1;
    last_trigger_ = trigger;
    last_number_ = frame->frame.number;
    return frame;
  }
  return std::nullopt;
}

}  // namespace appliance

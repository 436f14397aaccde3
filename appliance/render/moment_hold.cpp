#include "appliance/render/moment_hold.h"

#include <algorithm>
#include <utility>

namespace appliance {
namespace {

void dropAll(std::vector<std::optional<PinnedFrame>>& frames) RT_SAFE {
  for (auto& frame : frames) frame.reset();
}

}  // namespace

MomentHold::MomentHold(StoredFrames& memory)
    : memory_(memory), held_(memory.cameras()), next_(memory.cameras()) {}

void MomentHold::keep(std::uint64_t trigger) RT_SAFE {
  if (trigger == 0) {
    dropAll(held_);
    trigger_ = 0;
  } else if (trigger == trigger_) {
    (void)pinAll(held_, trigger);
  } else if (pinAll(next_, trigger)) {
    std::swap(held_, next_);
    trigger_ = trigger;
    dropAll(next_);
  }
}

bool MomentHold::pinAll(Frames& frames, std::uint64_t trigger) RT_SAFE {
  for (std::uint32_t camera = 0; camera < frames.size(); ++camera) {
    if (!frames[camera]) frames[camera] = memory_.tryPin(camera, trigger);
  }
  return std::ranges::any_of(frames, [](const auto& frame) { return frame.has_value(); });
}

const PinnedFrame* MomentHold::heldFrame(std::uint32_t camera,
                                         std::uint64_t trigger) const RT_SAFE {
  const bool held = trigger != 0 && trigger == trigger_ && held_[camera].has_value();
  return held ? &*held_[camera] : nullptr;
}

bool MomentHold::holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE {
  return heldFrame(camera, trigger) != nullptr || memory_.holds(camera, trigger);
}

std::optional<PinnedFrame> MomentHold::tryPin(std::uint32_t camera, std::uint64_t trigger) RT_SAFE {
  if (const PinnedFrame* frame = heldFrame(camera, trigger)) return frame->tryAgain();
  return memory_.tryPin(camera, trigger);
}

}  // namespace appliance

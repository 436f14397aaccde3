#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "appliance/render/stored_frames.h"

namespace appliance {

/// Keeps all cameras' frames of one moment, so that a stopped picture stays what it is and can be
/// walked around, however long capture goes on. It stands before a memory: a caller of it finds
/// the held frames and, besides, everything that the memory holds.
///
/// Threads  The render thread.
/// RT       RT safe; the constructor allocates.
/// Memory   Holds one pin per camera, two while the moment changes: kPinsPerCamera. tryPin() takes
///          one more for each frame that it gives.
class MomentHold final : public StoredFrames {
 public:
  static constexpr std::uint32_t kPinsPerCamera = 2;

  /// @p memory outlives the hold.
  explicit MomentHold(StoredFrames& memory);

  /// Holds the moment @p trigger from now on, in place of the one before; 0: none. If no camera's
  /// frame of it can be pinned, the moment before stays held. Frames that arrive later are added
  /// by the next calls with the same trigger.
  void keep(std::uint64_t trigger) RT_SAFE;

  [[nodiscard]] std::uint64_t heldTrigger() const RT_SAFE override { return trigger_; }
  [[nodiscard]] std::uint32_t cameras() const RT_SAFE override { return memory_.cameras(); }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const RT_SAFE override {
    return memory_.range(camera);
  }
  [[nodiscard]] bool living(std::uint32_t camera) const RT_SAFE override {
    return memory_.living(camera);
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE override;
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint32_t camera,
                                                  std::uint64_t trigger) RT_SAFE override;

 private:
  using Frames = std::vector<std::optional<PinnedFrame>>;  // one per camera; none: it has no frame

  /// True if at least one camera has a frame of @p trigger.
  bool pinAll(Frames& frames, std::uint64_t trigger) RT_SAFE;
  /// None if that frame is not held.
  [[nodiscard]] const PinnedFrame* heldFrame(std::uint32_t camera,
                                             std::uint64_t trigger) const RT_SAFE;

  StoredFrames& memory_;
  std::uint64_t trigger_ = 0;  // of the held moment; 0: none
  Frames held_;
  Frames next_;  // empty but for the time of a change
};

}  // namespace appliance

#pragma once

#include <cstdint>
#include <optional>

#include "appliance/capture/edge_board.h"
#include "appliance/capture/frame_history.h"
#include "appliance/render/stored_frames.h"

namespace appliance {

/// The frame history through the render loop's reader.
///
/// Threads  The render thread.
/// RT       RT safe.
class HistoryViews final : public StoredFrames {
 public:
  HistoryViews(FrameReader& reader, const EdgeBoard& edges) : reader_(reader), edges_(edges) {}

  [[nodiscard]] std::uint32_t cameras() const RT_SAFE override { return history().cameras(); }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const RT_SAFE override;
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE override;
  [[nodiscard]] bool living(std::uint32_t camera) const RT_SAFE override;
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint32_t camera,
                                                  std::uint64_t trigger) RT_SAFE override;

 private:
  [[nodiscard]] const FrameHistory& history() const RT_SAFE { return reader_.history(); }

  FrameReader& reader_;
  const EdgeBoard& edges_;
};

}  // namespace appliance

#pragma once

#include <cstdint>
#include <optional>

#include "appliance/capture/frame_reader.h"
#include "rt/annotations.h"

namespace appliance {

/// Reads one camera's frames along, each once and in order, beside the camera that stores them.
/// It begins with the newest frame. The camera does nothing for it: the reader polls, at least
/// once in the time that the history holds.
///
/// Threads  One: the reader's.
/// RT       RT safe; tryNext() looks at as many triggers as the camera left without a frame.
class FrameCursor {
 public:
  FrameCursor(FrameReader& reader, std::uint32_t camera) : reader_(reader), camera_(camera) {}

  /// The frame after the last one; nothing if there is none yet, or if the reader's budget is
  /// used up (drop a pin and ask again).
  [[nodiscard]] std::optional<PinnedFrame> tryNext() RT_SAFE;

  /// Stored frames that newer ones had overtaken before the cursor came to them.
  [[nodiscard]] std::uint64_t tooSlowFor() const RT_SAFE { return too_slow_for_; }

 private:
  FrameReader& reader_;
  const std::uint32_t camera_;
  std::uint64_t last_trigger_ = 0;  // given out; 0: none yet
  std::uint64_t last_number_ = 0;   // StoredFrame::number of it
  std::uint64_t too_slow_for_ = 0;
};

}  // namespace appliance

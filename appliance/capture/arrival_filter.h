#pragma once

#include <algorithm>
#include <chrono>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// When a frame's leader arrived, cleared of how late this machine looked at it.
///
/// Twenty cameras send at once and share few cores: a leader may wait most of a period in its
/// socket, long enough to be taken for the next trigger's. The camera stamped the frame with its
/// own clock, which knows nothing of our load. The smallest difference between arrival and
/// camera clock over the last seconds is that of a leader that did not wait; added to a frame's
/// camera clock it gives the arrival. The window is short enough that drift between the clocks
/// (100 ppm: 0.4 ms over two windows) does not matter, and that a clock that was set is
/// followed after two of them, at once if it was set forward.
///
/// Threads  One: the camera's receive thread.
/// RT       Wait-free.
class ArrivalFilter {
 public:
  static constexpr rt::Nanoseconds kWindow = std::chrono::seconds(2);

  /// @p stamped: when this machine looked. @p camera_clock: zero where the camera has none.
  [[nodiscard]] rt::Timestamp arrival(rt::Timestamp stamped, rt::Nanoseconds camera_clock) RT_SAFE {
    if (camera_clock == rt::Nanoseconds{0}) return stamped;
    const rt::Timestamp difference = stamped - camera_clock;
    if (stamped - window_begin_ >= 2 * kWindow) {  // the first frame, or the first in a long time
      before_ = now_ = difference;
      window_begin_ = stamped;
    } else if (stamped - window_begin_ >= kWindow) {
      before_ = now_;
      now_ = difference;
      window_begin_ = stamped;
    }
    now_ = std::min(now_, difference);
    return camera_clock + std::min(before_, now_);
  }

 private:
  rt::Timestamp window_begin_;  // the epoch: far more than two windows ago
  rt::Timestamp before_;        // smallest difference of the window before this one
  rt::Timestamp now_;           // and of this one so far
};

}  // namespace appliance

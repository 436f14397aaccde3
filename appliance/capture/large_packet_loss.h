#pragma once

#include <cstdint>

#include "hal/camera.h"

namespace appliance {

/// Detects that only the small packets of each frame arrive. This happens when the MTU of a link is
/// lowered while the camera runs: leader and trailer are below any MTU, the payload is not.
/// Ordinary loss leaves most packets; a dead camera sends no frame at all.
///
/// Pure: the caller gives it the counts of Camera::statistics() from time to time.
class LargePacketLoss {
 public:
  /// @p packets: of a frame, leader and trailer included.
  explicit LargePacketLoss(std::uint32_t packets) : packets_(packets) {}

  /// Whether, by now, every large packet vanishes: kFrames frames without one, and no complete one
  /// since. @p counts may start again from 0, as after Camera::start().
  [[nodiscard]] bool update(const hal::CameraStatistics& counts) {
    if (counts.frames_complete < last_.frames_complete ||
        counts.frames_incomplete < last_.frames_incomplete) {
      last_ = {};
      frames_ = 0;
    }
    const std::uint64_t complete = counts.frames_complete - last_.frames_complete;
    const std::uint64_t incomplete = counts.frames_incomplete - last_.frames_incomplete;
    const std::uint64_t missing = counts.packets_missing - last_.packets_missing;
    last_ = counts;
    // Of a frame given up all packets from the first gap on count as missing.
    const bool all_missing = 10 * missing >= 9 * incomplete * (packets_ - 1);
    if (complete > 0 || (incomplete > 0 && !all_missing)) frames_ = 0;
    if (complete == 0 && all_missing) frames_ += incomplete;
    return frames_ >= kFrames;
  }

  static constexpr std::uint64_t kFrames = 3;

 private:
  std::uint32_t packets_;
  hal::CameraStatistics last_;
  std::uint64_t frames_ = 0;
};

}  // namespace appliance

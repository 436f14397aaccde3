#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "appliance/status/status.h"
#include "rt/clock.h"

namespace appliance {

/// Notices cameras that fall silent, fail in part or come back, and frames that were lost, a line
/// each. A camera's first lost frames are told at once, later ones summed: a bad cable loses some
/// at every look.
///
/// Threads  main.
class CameraWatch {
 public:
  /// Least time between two lines about one camera's lost frames.
  static constexpr rt::Nanoseconds kLossPeriod = std::chrono::seconds(5);

  /// What changed since the last look: "camera 7 (cam07): no frames for 0.4 s: check its cable,
  /// its power and its switch port". Once per trouble, however long it lasts.
  /// Frames that a silent camera owes are told by its silence, not counted.
  [[nodiscard]] std::vector<std::string> look(const Status& status, rt::Timestamp now);

 private:
  struct Seen {
    CameraTrouble told = CameraTrouble::kNone;
    std::uint64_t frames_lost = 0;
    std::uint64_t untold = 0;      ///< of the frames lost, those that no line has named yet
    rt::Timestamp loss_told_at{};  ///< zero: never
  };

  std::vector<Seen> seen_;
};

}  // namespace appliance

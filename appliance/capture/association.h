#pragma once

#include <cstdint>
#include <optional>

#include "appliance/capture/edge_board.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// Names the trigger of a frame by time: the edge nearest to the leader's arrival minus the
/// camera's known delay, if it is nearer than half a period. A camera that ignored a trigger
/// counts its frames without a gap, so frame ids cannot name it; time can.
///
/// Threads  Any, against a board that is being written.
/// RT       Bounded: looks at the few newest edges.
class Association {
 public:
  /// @p period: between triggers. @p camera_delay: from the edge to the leader's arrival on an
  /// idle wire (opto-isolator, trigger delay, exposure, read-out start).
  Association(rt::Nanoseconds period, rt::Nanoseconds camera_delay)
      : period_(period), camera_delay_(camera_delay) {}

  /// Nothing when no edge is near enough: such a frame is dropped and counted, never guessed.
  [[nodiscard]] std::optional<std::uint64_t> triggerOf(rt::Timestamp arrival,
                                                       const EdgeBoard& edges) const RT_SAFE;

 private:
  rt::Nanoseconds period_;
  rt::Nanoseconds camera_delay_;
};

}  // namespace appliance

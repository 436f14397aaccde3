#pragma once

#include <cstdint>
#include <optional>

#include "appliance/capture/edge_board.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// Whether the trigger line starts a camera's exposures.
enum class CameraPace : std::uint8_t { kTriggered, kFreeRunning };

/// Which trigger edge an instant belongs to. TriggerMatcher knows how reliable a frame's instants
/// are.
///
/// Threads  Any, against a board that is being written.
/// RT       Bounded: looks at the few newest edges.
class Association {
 public:
  /// @p period: between triggers. @p camera_delay: from the edge to the leader's arrival on an
  /// idle wire (opto-isolator, trigger delay, exposure, read-out start).
  Association(rt::Nanoseconds period, rt::Nanoseconds camera_delay,
              CameraPace pace = CameraPace::kTriggered)
      : period_(period), camera_delay_(camera_delay), pace_(pace) {}

  [[nodiscard]] CameraPace pace() const RT_SAFE { return pace_; }
  [[nodiscard]] rt::Nanoseconds period() const RT_SAFE { return period_; }

  /// The trigger whose frames' leaders arrive nearest to @p arrival; nothing if that is half a
  /// period away or more.
  [[nodiscard]] std::optional<std::uint64_t> triggerOf(rt::Timestamp arrival,
                                                       const EdgeBoard& edges) const RT_SAFE;

  /// The trigger whose edge lies less than @p within from @p fired.
  [[nodiscard]] static std::optional<std::uint64_t> edgeNear(rt::Timestamp fired,
                                                             rt::Nanoseconds within,
                                                             const EdgeBoard& edges) RT_SAFE;

  /// The trigger whose edge may lie less than @p within from @p fired, as far as the board knows
  /// when the edge left: a thread that was stopped while it drove the line does not know it well.
  [[nodiscard]] static std::optional<std::uint64_t> edgeMaybeNear(rt::Timestamp fired,
                                                                  rt::Nanoseconds within,
                                                                  const EdgeBoard& edges) RT_SAFE;

  /// Whether a leader of the edge @p edge can have been read at @p arrival: it cannot come half a
  /// period before it is due. It can be late by any time, because machines are busy.
  [[nodiscard]] bool canArrive(rt::Timestamp edge, rt::Timestamp arrival) const RT_SAFE {
    return 2 * (edge + camera_delay_ - arrival) < period_;
  }

 private:
  rt::Nanoseconds period_;
  rt::Nanoseconds camera_delay_;
  CameraPace pace_;
};

}  // namespace appliance

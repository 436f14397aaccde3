#pragma once

#include <chrono>
#include <cstdint>

#include "appliance/capture/genlock_status.h"
#include "hal/display_timing.h"
#include "rt/clock.h"

namespace appliance {

/// While triggers are locked to the screen, each trigger's picture has one vblank at which it
/// should flip. A picture that is done a whole vblank early waits. A picture that would make the
/// next one late is not drawn.
///
/// Threads  Any; pure: time is an argument.
class LockedVblanks {
 public:
  /// @p lock: of state kLocked.
  LockedVblanks(const hal::DisplayTiming& timing, const GenlockStatus& lock)
      : timing_(timing), lead_(lock.lead), vblanks_per_trigger_(lock.vblanks_per_trigger) {}

  /// The vblank that the picture of a trigger is meant for.
  [[nodiscard]] std::uint64_t of(rt::Timestamp trigger_edge) const {
    const rt::Nanoseconds half(static_cast<std::int64_t>(timing_.period_ns / 2));
    return timing_.firstVblankAfter(trigger_edge + lead_ - half);
  }

  /// A commit before this would show the picture a vblank too early.
  [[nodiscard]] rt::Timestamp earliestCommit(rt::Timestamp trigger_edge) const {
    return timing_.vblankAt(of(trigger_edge) - 1) + kSurelyPast;
  }

  /// Whether a redraw started @p now flips before the next trigger's picture is due. Also true if
  /// that picture is overdue. @p shown_edge: of the trigger that is drawn.
  [[nodiscard]] bool redrawFits(rt::Timestamp now, rt::Timestamp shown_edge) const {
    const std::uint64_t next = of(shown_edge) + vblanks_per_trigger_;
    if (now > timing_.vblankAt(next)) return true;
    return timing_.firstVblankAfter(now + timing_.draw + timing_.commit_margin) < next;
  }

 private:
  /// More than the error of a predicted vblank.
  static constexpr rt::Nanoseconds kSurelyPast = std::chrono::microseconds(200);

  hal::DisplayTiming timing_;
  rt::Nanoseconds lead_;
  std::uint32_t vblanks_per_trigger_;
};

}  // namespace appliance

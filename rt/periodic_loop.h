#pragma once

#include <cassert>
#include <cstdint>
#include <optional>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace rt {

/// One turn of a periodic loop.
struct PeriodicTick {
  std::uint64_t index = 0;   ///< deadlines since the first one, missed ones included; from 0
  Timestamp deadline;        ///< the instant this turn was due
  Nanoseconds lateness{0};   ///< how late the thread woke: the wake latency
  std::uint64_t missed = 0;  ///< deadlines lost since the turn before this one
};

/// Decides which turn of a periodic loop is due: a grid of absolute deadlines.
///
/// Overruns are skipped and counted, never made up for: there is at most one turn
/// per deadline, always for the newest deadline that has passed, and a deadline
/// later than max_lateness is given up. Errors do not add up, because every
/// deadline is computed from the one before it, not from the time of waking.
///
/// Threads  One thread.
/// RT       Every member is RT safe: arithmetic on the given instant.
class PeriodicSchedule {
 public:
  /// @p max_lateness less than @p period keeps two turns at least
  /// period - max_lateness apart; unset, any lateness below one period is served.
  PeriodicSchedule(Timestamp first_deadline, Nanoseconds period,
                   std::optional<Nanoseconds> max_lateness = std::nullopt) noexcept
      : deadline_(first_deadline), period_(period), max_lateness_(max_lateness.value_or(period)) {
    assert(period > Nanoseconds{0});
    assert(max_lateness_ >= Nanoseconds{0});
  }

  /// Until when to sleep.
  [[nodiscard]] Timestamp deadline() const RT_SAFE { return deadline_; }
  [[nodiscard]] Nanoseconds period() const RT_SAFE { return period_; }
  /// Deadlines lost since the beginning.
  [[nodiscard]] std::uint64_t missed() const RT_SAFE { return missed_; }

  /// The turn to run at @p now; nullopt when there is none (woken early, or too
  /// late for it): sleep until deadline() again.
  [[nodiscard]] std::optional<PeriodicTick> wake(Timestamp now) RT_SAFE {
    if (now < deadline_) return std::nullopt;
    const auto passed = static_cast<std::uint64_t>((now - deadline_) / period_);
    const Timestamp due = deadline_ + passed * period_;
    const std::uint64_t due_index = index_ + passed;
    const bool too_late = now - due > max_lateness_;
    const std::uint64_t lost = passed + (too_late ? 1 : 0);

    deadline_ = due + period_;
    index_ = due_index + 1;
    missed_ += lost;
    missed_since_tick_ += lost;
    if (too_late) return std::nullopt;
    const PeriodicTick tick{due_index, due, now - due, missed_since_tick_};
    missed_since_tick_ = 0;
    return tick;
  }

  /// Moves all coming deadlines by @p shift, |shift| < period: the step of a phase control loop.
  void nudge(Nanoseconds shift) RT_SAFE {
    assert(shift > -period_ && shift < period_);
    deadline_ += shift;
  }

 private:
  Timestamp deadline_;
  Nanoseconds period_;
  Nanoseconds max_lateness_;
  std::uint64_t index_ = 0;  // of deadline_
  std::uint64_t missed_ = 0;
  std::uint64_t missed_since_tick_ = 0;
};

/// Sleeps until @p deadline on CLOCK_MONOTONIC; signals do not end it early.
/// RT  The one sleep a real-time loop may make, exempt inside rt::ScopedRtSection.
void sleepUntil(Timestamp deadline) noexcept;

/// A periodic loop's effect: its own sleep, and the schedule that decides.
///
///     while (!stop.stop_requested()) {
///       const auto tick = loop.wait();
///       if (!tick) continue;  // given up, counted
///       ...
///     }
///
/// Threads  One thread.
/// RT       wait() blocks in its own sleep only; the rest is RT safe.
class PeriodicLoop {
 public:
  explicit PeriodicLoop(const PeriodicSchedule& schedule) noexcept : schedule_(schedule) {}

  /// Sleeps until the next deadline; nullopt when it woke too late to serve it.
  /// Returns at least once a period, so a caller can look at its stop token.
  [[nodiscard]] std::optional<PeriodicTick> wait() noexcept {
    sleepUntil(schedule_.deadline());
    return schedule_.wake(now());
  }

  [[nodiscard]] PeriodicSchedule& schedule() RT_SAFE { return schedule_; }

 private:
  PeriodicSchedule schedule_;
};

}  // namespace rt

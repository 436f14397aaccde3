#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>

#include "appliance/capture/edge_board.h"
#include "appliance/capture/genlock.h"
#include "appliance/capture/genlock_board.h"
#include "appliance/trace/trace_writer.h"
#include "hal/trigger_line.h"
#include "rt/clock.h"
#include "rt/counter.h"
#include "rt/duration_window.h"
#include "rt/periodic_loop.h"

namespace appliance {

/// How the trigger line is pulsed.
struct TriggerTiming {
  rt::Nanoseconds period;
  rt::Nanoseconds pulse_width;  ///< active this long; less than half a period
  bool genlock = false;         ///< in phase with the screen where the rates allow it
  rt::Nanoseconds genlock_margin{};
};

/// What the trigger thread counts about itself.
struct TriggerMetrics {
  rt::Counter edges;            ///< pulses that left
  rt::Counter missed;           ///< pulses given up because the thread woke too late
  rt::Counter failed;           ///< edges that the line did not take
  rt::DurationWindow lateness;  ///< from a pulse's deadline until it had left
};

/// Fires the cameras: one pulse per period on an absolute grid, never paused. The genlock moves
/// the grid's coming deadlines, a little per pulse.
///
/// A pulse more than a fifth of a period late is given up, because cameras would ignore the second
/// of two pulses that are too close to each other.
///
/// Threads  run(): the `trigger` thread. The counters: any thread.
/// RT       run() sleeps, drives the line, posts the edge; nothing else.
class TriggerLoop {
 public:
  TriggerLoop(TriggerTiming timing, hal::TriggerLine& line, EdgeBoard& edges,
              GenlockBoard& genlock_board, TraceProducer* trace)
      : timing_(timing),
        line_(line),
        edges_(edges),
        genlock_board_(genlock_board),
        genlock_(
            {.enabled = timing.genlock, .period = timing.period, .margin = timing.genlock_margin}),
        trace_(trace) {}

  /// Until stopped. The line is inactive when it returns.
  void run(const std::stop_token& stop) noexcept;

  [[nodiscard]] const TriggerMetrics& metrics() const { return metrics_; }
  /// Whether the line did not take the newest edge.
  [[nodiscard]] bool failing() const { return failing_.load(std::memory_order_relaxed); }

 private:
  void pulse(rt::Timestamp deadline) noexcept;
  [[nodiscard]] rt::Result<hal::TriggerEdge> drive(bool active) noexcept;
  void steer(rt::PeriodicSchedule& schedule) noexcept;
  void recordGenlock() noexcept;

  const TriggerTiming timing_;
  hal::TriggerLine& line_;
  EdgeBoard& edges_;
  GenlockBoard& genlock_board_;
  Genlock genlock_;
  GenlockStatus recorded_;  // the last one in the trace
  std::uint32_t since_recorded_ = 0;
  TraceProducer* trace_;  // none: not traced
  std::uint64_t trigger_ = 0;
  TriggerMetrics metrics_;
  std::atomic<bool> failing_{false};
};

}  // namespace appliance

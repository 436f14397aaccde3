#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>

#include "appliance/capture/edge_board.h"
#include "appliance/trace/trace_writer.h"
#include "hal/trigger_line.h"
#include "rt/clock.h"

namespace appliance {

/// How the trigger line is pulsed.
struct TriggerTiming {
  rt::Nanoseconds period;
  rt::Nanoseconds pulse_width;  ///< active this long; less than half a period
};

/// Fires the cameras: one pulse per period on an absolute grid, never paused.
///
/// A pulse more than a fifth of a period late is given up, for two pulses too close to each
/// other would make cameras ignore the second one.
///
/// Threads  run(): the `trigger` thread. The counters: any thread.
/// RT       run() sleeps, drives the line, posts the edge; nothing else.
class TriggerLoop {
 public:
  TriggerLoop(TriggerTiming timing, hal::TriggerLine& line, EdgeBoard& edges, TraceProducer* trace)
      : timing_(timing), line_(line), edges_(edges), trace_(trace) {}

  /// Until stopped. The line is inactive when it returns.
  void run(const std::stop_token& stop) noexcept;

  /// Pulses given up because the thread woke too late.
  [[nodiscard]] std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }
  /// Pulses that the line did not take.
  [[nodiscard]] std::uint64_t failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  void pulse(rt::Timestamp deadline) noexcept;

  const TriggerTiming timing_;
  hal::TriggerLine& line_;
  EdgeBoard& edges_;
  TraceProducer* trace_;  // none: not traced
  std::uint64_t trigger_ = 0;
  std::atomic<std::uint64_t> missed_{0};
  std::atomic<std::uint64_t> failed_{0};
};

}  // namespace appliance

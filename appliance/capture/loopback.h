#pragma once

#include <cstdint>
#include <expected>
#include <stop_token>
#include <string>

#include "appliance/capture/association.h"
#include "appliance/capture/edge_board.h"
#include "appliance/trace/trace_writer.h"
#include "hal/edge_input.h"
#include "hal/trigger_line.h"
#include "rt/clock.h"

namespace appliance {

/// What the loop-back input read before, during and after one test pulse of the trigger line.
struct LoopbackReading {
  bool before = false;  ///< active
  bool during = false;
  bool after = false;
  bool edge = false;  ///< an edge was stamped when the pulse began
};

/// What such a reading says about the wiring: nothing wrong, or one line for a person. Pure.
[[nodiscard]] std::expected<void, std::string> judgeLoopback(const LoopbackReading& reading);

/// Sends one short test pulse and judges what comes back. The line is inactive afterwards.
///
/// Threads  The owner, while no other thread drives the line and no camera takes frames.
/// Errors   One line: polarity, wiring, or a device that is gone.
[[nodiscard]] std::expected<void, std::string> checkLoopback(hal::TriggerLine& line,
                                                             hal::EdgeInput& input);

/// Collects the edges that come back while the cameras are fired, and records for each which
/// trigger it was and when it was seen: the report computes the box's own edge delay from that.
///
/// Threads  run(): the `loopback` thread.
/// RT       Not RT safe: the kernel stamps the edges, so they may be read late.
class LoopbackLoop {
 public:
  LoopbackLoop(rt::Nanoseconds period, hal::EdgeInput& input, const EdgeBoard& edges,
               TraceProducer& trace)
      : association_(period, rt::Nanoseconds{0}), input_(input), edges_(edges), trace_(trace) {}

  void run(const std::stop_token& stop);

 private:
  [[nodiscard]] std::uint64_t triggerOf(rt::Timestamp edge) const;

  Association association_;
  hal::EdgeInput& input_;
  const EdgeBoard& edges_;
  TraceProducer& trace_;
};

}  // namespace appliance

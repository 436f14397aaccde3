#pragma once

#include <optional>

#include "rt/clock.h"
#include "rt/result.h"

namespace hal {

/// One change of an input.
struct InputEdge {
  bool active = false;  ///< the level after it
  rt::Timestamp at;     ///< as the kernel stamped it
};

/// One input whose every edge is stamped by the kernel: the loop-back of the trigger line.
/// Polarity is the backend's business: callers say active.
///
/// Threads  One caller at a time.
/// RT       waitEdge() blocks; nothing here is for a real-time thread.
/// Errors   An input that vanished delivers no more edges, and its level is kDeviceLost.
class EdgeInput {
 public:
  virtual ~EdgeInput() = default;

  /// Edges in order; nothing after @p timeout.
  [[nodiscard]] virtual std::optional<InputEdge> waitEdge(rt::Nanoseconds timeout) = 0;

  /// The level now, read from the hardware.
  [[nodiscard]] virtual rt::Result<bool> isActive() = 0;
};

}  // namespace hal

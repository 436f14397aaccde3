#pragma once

#include "rt/clock.h"

namespace appliance {

/// SIGINT and SIGTERM as something to ask for, in place of handlers.
///
/// Blocks both for the calling thread and all threads it makes afterwards: construct it first.
/// Threads  main.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// True as soon as one of them came; stays true.
  [[nodiscard]] bool requested() { return waitFor(rt::Nanoseconds{0}); }

  /// Waits for one, at most @p timeout.
  bool waitFor(rt::Nanoseconds timeout);

 private:
  int fd_;
  bool requested_ = false;
};

}  // namespace appliance

#pragma once

#include "rt/clock.h"
#include "rt/unique_fd.h"

namespace rt {

/// SIGINT and SIGTERM as a state that can be polled, instead of handlers.
///
/// Blocks both for the calling thread and all threads it makes afterwards, those of libraries too:
/// construct it first thing in main().
/// Threads  main.
class StopSignals {
 public:
  StopSignals();

  /// True as soon as one of them came; stays true.
  [[nodiscard]] bool requested() { return waitFor(Nanoseconds{0}); }

  /// Waits for one, at most @p timeout.
  bool waitFor(Nanoseconds timeout);

  /// Readable after a signal; for poll() together with other descriptors. -1 if there is none.
  [[nodiscard]] int fd() const { return fd_.get(); }

 private:
  UniqueFd fd_;
  bool requested_ = false;
};

}  // namespace rt

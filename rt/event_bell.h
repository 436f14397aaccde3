#pragma once

#include <cstdint>

#include <sys/eventfd.h>
#include <unistd.h>

#include "rt/annotations.h"
#include "rt/unique_fd.h"

namespace rt {

/// Wakes an event loop: "look at your rings again". A Doorbell for a thread that waits in poll().
///
/// Rings are counted, so one that comes before the wait is not lost. The data itself crosses in a
/// ring or a latest value, written before ring().
///
/// Threads  ring(): any. The rest: the thread of the event loop.
/// RT       ring() is one bounded system call that never blocks. For rare events: a Doorbell costs
///          nothing while no thread waits.
/// Errors   Without a descriptor (valid() is false) ring() does nothing.
class EventBell {
 public:
  EventBell() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

  [[nodiscard]] bool valid() const { return fd_.valid(); }

  void ring() const RT_SAFE {
    const std::uint64_t one = 1;
    // A full counter means that the bell rings already.
    [[maybe_unused]] const auto written = ::write(fd_.get(), &one, sizeof one);
  }

  /// Readable while it rings.
  [[nodiscard]] int fd() const { return fd_.get(); }

  /// True if it was rung since the last call.
  [[nodiscard]] bool takeRings() const {
    std::uint64_t rings = 0;
    return ::read(fd_.get(), &rings, sizeof rings) == sizeof rings;
  }

 private:
  UniqueFd fd_;
};

}  // namespace rt

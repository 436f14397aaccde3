#pragma once

#include "rt/doorbell.h"
#include "rt/thread.h"

namespace rt {

/// A thread that waits for a doorbell. Stopping it includes ringing: otherwise the thread sees its
/// stop token only when something else rings; stop() does both.
///
/// Threads  The owner's, as rt::Thread.
class RingedThread {
 public:
  /// @p bell: what the body waits for. It outlives this object.
  explicit RingedThread(Doorbell& bell) : bell_(bell) {}
  RingedThread(const RingedThread&) = delete;
  RingedThread& operator=(const RingedThread&) = delete;
  ~RingedThread() { stop(); }

  /// Where the started thread is put.
  [[nodiscard]] Thread& thread() noexcept { return thread_; }

  /// Returns when the body has returned. Idempotent; without a thread it does nothing.
  void stop() noexcept {
    if (!thread_.joinable()) return;
    thread_.requestStop();
    bell_.ring();
    thread_.join();
  }

 private:
  Doorbell& bell_;
  Thread thread_;
};

}  // namespace rt

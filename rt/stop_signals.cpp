#include "rt/stop_signals.h"

#include <csignal>

#include <poll.h>
#include <sys/signalfd.h>

namespace rt {

StopSignals::StopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  fd_ = UniqueFd(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
}

bool StopSignals::waitFor(Nanoseconds timeout) {
  if (requested_) return true;
  pollfd input{fd_.get(), POLLIN, 0};
  const auto timeout_ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout).count();
  requested_ = poll(&input, 1, static_cast<int>(timeout_ms)) > 0;
  return requested_;
}

}  // namespace rt

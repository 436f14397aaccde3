#include "appliance/stop_signals.h"

#include <csignal>

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace appliance {

StopSignals::StopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

StopSignals::~StopSignals() {
  close(fd_);
}

bool StopSignals::waitFor(rt::Nanoseconds timeout) {
  if (requested_) return true;
  pollfd input{fd_, POLLIN, 0};
  const auto timeout_ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout).count();
  requested_ = poll(&input, 1, static_cast<int>(timeout_ms)) > 0;
  return requested_;
}

}  // namespace appliance

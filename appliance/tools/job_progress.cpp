#include "appliance/tools/job_progress.h"

#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>

#include <pthread.h>
#include <unistd.h>

#include "appliance/tools/commands.h"

namespace appliance {
namespace {

constexpr int kLook_ms = 100;  // as often as the daemon looks itself

sigset_t endingSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

void show(const JobReport& job) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\r%3ld %%", std::lround(100 * job.progress));
  if (job.state != JobState::kRunning) std::fputs("\n", stderr);
}

}  // namespace

HeldSignals::HeldSignals() {
  const sigset_t signals = endingSignals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

HeldSignals::~HeldSignals() {
  const sigset_t signals = endingSignals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

int HeldSignals::waitOne(int milliseconds) const {
  const sigset_t signals = endingSignals();
  const timespec limit{.tv_sec = milliseconds / 1000, .tv_nsec = milliseconds % 1000 * 1'000'000L};
  const int came = sigtimedwait(&signals, nullptr, &limit);
  return came > 0 ? came : 0;
}

std::string followJob(ControlClient& client, const std::string& path, const HeldSignals& signals) {
  int signal = 0;
  for (;;) {
    const auto job = client.job(path);
    if (!job) fail(job.error());
    show(*job);
    if (job->state == JobState::kDone) return job->result;
    if (job->state == JobState::kFailed) fail(job->result);
    if (job->state == JobState::kCancelled) {
      std::fprintf(stderr, "kagami: %s\n", job->result.c_str());
      throw CommandFailed{.status = signal > 0 ? 128 + signal : 1};
    }
    const int came = signals.waitOne(kLook_ms);
    if (came == 0) continue;
    if (signal == 0) signal = came;
    if (const auto asked = client.cancelJob(path); !asked) fail(asked.error());
  }
}

}  // namespace appliance

#include "rt/periodic_loop.h"

#include <cerrno>
#include <ctime>

#include "rt/section.h"

namespace rt {

void sleepUntil(Timestamp deadline) noexcept {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  const std::int64_t ns = toNs(deadline);
  if (ns <= 0) return;  // before boot: the kernel refuses negative instants
  const timespec until{.tv_sec = ns / kNsPerSecond, .tv_nsec = ns % kNsPerSecond};
  const ScopedRtExemption exemption("a real-time loop's own absolute sleep");
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace rt

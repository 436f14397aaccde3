#include "rt/doorbell.h"

#include <cerrno>
#include <ctime>

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "rt/section.h"

namespace rt {
namespace {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t) &&
                  std::atomic<std::uint32_t>::is_always_lock_free,
              "the kernel compares the atomic's own bytes");

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

/// Sleeps while @p word is @p expected; the error number, or 0 when woken.
int futexWait(std::atomic<std::uint32_t>& word, std::uint32_t expected,
              const timespec& until) noexcept {
  // WAIT_BITSET takes an absolute instant on CLOCK_MONOTONIC; plain WAIT a duration.
  const long rc = syscall(SYS_futex, &word, FUTEX_WAIT_BITSET | FUTEX_PRIVATE_FLAG, expected,
                          &until, nullptr, FUTEX_BITSET_MATCH_ANY);
  return rc == 0 ? 0 : errno;
}

void futexWakeOne(std::atomic<std::uint32_t>& word) noexcept {
  syscall(SYS_futex, &word, FUTEX_WAKE | FUTEX_PRIVATE_FLAG, 1, nullptr, nullptr, 0);
}

}  // namespace

void Doorbell::ring() RT_SAFE {
  rings_.fetch_add(1);
  if (waiting_.load() == 0) return;
  const ScopedRtExemption exemption("futex wake: bounded, never blocks");
  futexWakeOne(rings_);
}

bool Doorbell::takeRing() noexcept {
  const std::uint32_t rings = rings_.load();
  if (rings == seen_) return false;
  seen_ = rings;
  return true;
}

bool Doorbell::waitUntil(Timestamp deadline) noexcept {
  if (takeRing()) return true;
  const std::int64_t ns = toNs(deadline);
  if (ns <= 0) return false;
  const timespec until{.tv_sec = ns / kNsPerSecond, .tv_nsec = ns % kNsPerSecond};

  const ScopedRtExemption exemption("a real-time loop's own wait");
  waiting_.store(1);
  bool rung = takeRing();
  while (!rung) {
    const int error = futexWait(rings_, seen_, until);
    rung = takeRing();
    if (error == ETIMEDOUT) break;
  }
  waiting_.store(0);
  return rung;
}

}  // namespace rt

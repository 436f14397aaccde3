#include <array>
#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <pthread.h>
#include <time.h>
#include <unistd.h>

#include "rt/section.h"

namespace {

/// Runs @p forbidden in a section; it must abort and name the call.
template <typename Forbidden>
void expectAbort(const Forbidden& forbidden, const std::string& call) {
  EXPECT_DEATH(
      {
        const rt::ScopedRtSection section;
        forbidden();
      },
      "rt: " + call + "\\(\\) called inside a real-time section of thread '.+'");
}

TEST(RtSectionDeathTest, AbortsOnEveryWayToAllocate) {
  // What is stored in a volatile may be looked at, so no optimiser leaves the allocation out.
  expectAbort(
      [] {
        const auto p = std::make_unique<std::array<int, 9>>();
        const void* volatile kept = p.get();
        (void)kept;
      },
      "malloc");
  expectAbort(
      [] {
        const std::vector<std::string> strings(3, std::string(100, 'x'));
        const void* volatile kept = strings.data();
        (void)kept;
      },
      "malloc");
  expectAbort(
      [] {
        void* volatile p = std::malloc(1);
        (void)p;
      },
      "malloc");
  expectAbort(
      [] {
        void* volatile p = std::calloc(1, 1);
        (void)p;
      },
      "calloc");
  expectAbort(
      [] {
        void* volatile p = std::aligned_alloc(64, 64);
        (void)p;
      },
      "aligned_alloc");
  expectAbort(
      [] {
        void* p = nullptr;
        (void)posix_memalign(&p, 64, 64);
      },
      "posix_memalign");
  void* const block = std::malloc(16);
  expectAbort(
      [block] {
        void* volatile p = std::realloc(block, 32);
        (void)p;
      },
      "realloc");
  expectAbort([block] { std::free(block); }, "free");
  std::free(block);
}

TEST(RtSectionDeathTest, AbortsOnEveryWayToLockOrWait) {
  std::mutex mutex;
  expectAbort([&] { const std::lock_guard lock(mutex); }, "pthread_mutex_lock");

  std::unique_lock held(mutex);
  std::condition_variable condition;
  const timespec past{.tv_sec = 1, .tv_nsec = 0};
  expectAbort([&] { condition.wait(held); }, "pthread_cond_wait");
  expectAbort(
      [&] {
        pthread_cond_timedwait(condition.native_handle(), held.mutex()->native_handle(), &past);
      },
      "pthread_cond_timedwait");
  expectAbort(
      [&] {
        pthread_cond_clockwait(condition.native_handle(), held.mutex()->native_handle(),
                               CLOCK_MONOTONIC, &past);
      },
      "pthread_cond_clockwait");
}

TEST(RtSectionDeathTest, AbortsOnEveryWayToSleep) {
  const timespec moment{.tv_sec = 0, .tv_nsec = 1};
  expectAbort([&] { nanosleep(&moment, nullptr); }, "nanosleep");
  expectAbort([&] { clock_nanosleep(CLOCK_MONOTONIC, 0, &moment, nullptr); }, "clock_nanosleep");
  expectAbort([] { usleep(1); }, "usleep");
  expectAbort([] { sleep(1); }, "sleep");
}

TEST(RtSectionDeathTest, ShowsWhereTheCallCameFrom) {
  EXPECT_DEATH(
      {
        const rt::ScopedRtSection section;
        usleep(1);
      },
      "rt_section_death_test");  // a line of the backtrace
}

TEST(RtSectionDeathTest, StillForbidsAfterANestedSectionOrAnExemptionEnds) {
  expectAbort(
      [] {
        {
          const rt::ScopedRtSection inner;
        }
        {
          const rt::ScopedRtExemption exemption("test");
        }
        usleep(1);
      },
      "usleep");
}

TEST(RtSectionDeathTest, ForbidsInASectionInsideAnExemption) {
  expectAbort(
      [] {
        const rt::ScopedRtExemption exemption("test");
        const rt::ScopedRtSection inner;
        usleep(1);
      },
      "usleep");
}

}  // namespace

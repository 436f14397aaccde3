#include <cstdlib>
#include <mutex>
#include <thread>
#include <type_traits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "rt/clock.h"
#include "rt/doorbell.h"
#include "rt/periodic_loop.h"
#include "rt/section.h"

namespace {

/// Everything that a section forbids, in a way that the optimiser cannot leave out.
void allocateLockAndSleep() {
  void* volatile block = std::malloc(32);
  std::free(block);
  std::mutex mutex;
  const std::lock_guard lock(mutex);
  usleep(1);
}

TEST(RtSection, ForbidsNothingOutside) {
  {
    const rt::ScopedRtSection section;
  }
  allocateLockAndSleep();
  SUCCEED();
}

TEST(RtSection, ForbidsNothingInsideAnExemption) {
  const rt::ScopedRtSection section;
  const rt::ScopedRtExemption exemption("test");
  allocateLockAndSleep();
  SUCCEED();
}

TEST(RtSection, BindsOnlyTheThreadThatEnteredIt) {
  std::jthread other;
  {
    const rt::ScopedRtSection section;
    const rt::ScopedRtExemption exemption("starting a thread allocates");
    other = std::jthread(allocateLockAndSleep);
  }
}

TEST(RtSection, PermitsALoopsOwnSleepAndADoorbell) {
  rt::Doorbell bell;
  rt::PeriodicLoop loop(rt::PeriodicSchedule(rt::now(), std::chrono::milliseconds(1)));
  const rt::ScopedRtSection section;
  for (int i = 0; i < 3; ++i) (void)loop.wait();
  bell.ring();
  (void)bell.waitUntil(rt::now());
  (void)bell.waitUntil(rt::now());
}

#ifndef KAGAMI_RTCHECK
static_assert(std::is_empty_v<rt::ScopedRtSection> && std::is_empty_v<rt::ScopedRtExemption>,
              "outside the rtcheck build a section costs nothing");
#endif

}  // namespace

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include "rt/clock.h"
#include "rt/limits.h"
#include "rt/ringed_thread.h"
#include "rt/thread.h"

namespace {

using rt::SchedPolicy;

rt::TaskInfo self() {
  const auto tasks = rt::listTasks();
  const auto me = std::ranges::find(tasks, gettid(), &rt::TaskInfo::tid);
  return me == tasks.end() ? rt::TaskInfo{} : *me;
}

rt::Thread mustStart(rt::ThreadConfig config, std::function<void(std::stop_token)> body) {
  auto thread = rt::Thread::start(std::move(config), std::move(body));
  EXPECT_TRUE(thread.has_value());
  return thread ? std::move(*thread) : rt::Thread{};
}

/// Runs @p look on a thread made from @p config and gives back what it saw.
rt::TaskInfo seenBy(rt::ThreadConfig config, rt::ThreadGrant* grant = nullptr) {
  rt::TaskInfo seen;
  auto thread = mustStart(std::move(config), [&](const std::stop_token&) { seen = self(); });
  thread.join();
  if (grant != nullptr) *grant = thread.grant();
  return seen;
}

bool mayScheduleFifo() {
  const rt::Limits limits = rt::readLimits();
  return limits.may_schedule_any || limits.rt_priority >= 1;
}

TEST(Thread, CarriesItsNameWhereSystemToolsLookForIt) {
  EXPECT_EQ(seenBy({.name = "fifteen-letters"}).name, "fifteen-letters");
}

TEST(Thread, RefusesWhatNoSystemCouldGrant) {
  const auto refusal = [](const rt::ThreadConfig& config) -> std::optional<rt::Errc> {
    const auto thread = rt::Thread::start(config, [](const std::stop_token&) {});
    if (thread) return std::nullopt;
    return thread.error().code;
  };
  using enum rt::Errc;
  EXPECT_EQ(refusal({.name = ""}), kInvalidConfig);
  EXPECT_EQ(refusal({.name = "sixteen-letters!"}), kInvalidConfig);
  EXPECT_EQ(refusal({.name = "t", .policy = SchedPolicy::kOther, .priority = 1}), kInvalidConfig);
  EXPECT_EQ(refusal({.name = "t", .policy = SchedPolicy::kFifo, .priority = 0}), kInvalidConfig);
  EXPECT_EQ(refusal({.name = "t", .policy = SchedPolicy::kFifo, .priority = 100}), kInvalidConfig);
  EXPECT_EQ(refusal({.name = "t", .policy = SchedPolicy::kForeign}), kInvalidConfig);
  EXPECT_EQ(refusal({.name = "t", .cpus = {-1}}), kInvalidConfig);
  EXPECT_EQ(refusal({.name = "t", .prefault_stack_bytes = rt::Thread::kStackBytes}),
            kInvalidConfig);
}

TEST(Thread, RunsUnderTheGrantedPolicyOrSaysThatItDoesNot) {
  rt::ThreadGrant grant;
  const auto task = seenBy({.name = "fifo", .policy = SchedPolicy::kFifo, .priority = 1}, &grant);

  EXPECT_EQ(grant.realtime, mayScheduleFifo());
  if (grant.realtime) {
    EXPECT_EQ(task.policy, SchedPolicy::kFifo);
    EXPECT_EQ(task.priority, 1);
    EXPECT_EQ(grant.os_errno, 0);
  } else {
    EXPECT_EQ(task.policy, SchedPolicy::kOther);
    EXPECT_EQ(task.priority, 0);
    EXPECT_EQ(grant.os_errno, EPERM);
  }
}

TEST(Thread, StaysOnTheCpusItWasGiven) {
  const auto allowed = self().cpus;
  ASSERT_FALSE(allowed.empty());
  rt::ThreadGrant grant;
  const auto task = seenBy({.name = "pinned", .cpus = {allowed.back()}}, &grant);
  EXPECT_TRUE(grant.affinity);
  EXPECT_THAT(task.cpus, testing::ElementsAre(allowed.back()));
}

TEST(Thread, RunsAnywhereAndSaysSoWhenItsCpuDoesNotExist) {
  rt::ThreadGrant grant;
  const auto task = seenBy({.name = "lost", .cpus = {CPU_SETSIZE - 1}}, &grant);
  EXPECT_FALSE(grant.affinity);
  EXPECT_FALSE(grant.complete());
  EXPECT_EQ(grant.os_errno, EINVAL);
  EXPECT_EQ(task.cpus, self().cpus);
}

TEST(Thread, MakesNoRealTimeChildrenByInheritance) {
  if (!mayScheduleFifo()) GTEST_SKIP() << "no permission for SCHED_FIFO here";
  rt::TaskInfo child;
  {
    auto parent = mustStart(
        {.name = "parent", .policy = SchedPolicy::kFifo, .priority = 2},
        [&](const std::stop_token&) { const std::jthread library([&] { child = self(); }); });
  }
  EXPECT_EQ(child.policy, SchedPolicy::kOther);
}

TEST(Thread, StopsAndJoinsOnDestruction) {
  std::atomic<bool> ended{false};
  {
    auto thread = mustStart({.name = "stopping"}, [&](const std::stop_token& stop) {
      while (!stop.stop_requested()) sched_yield();
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

TEST(Thread, MovesWithItsRunningBody) {
  std::atomic<int> ended{0};
  const auto untilStopped = [&](const std::stop_token& stop) {
    while (!stop.stop_requested()) sched_yield();
    ++ended;
  };
  auto first = mustStart({.name = "first"}, untilStopped);
  auto second = mustStart({.name = "second"}, untilStopped);
  first = std::move(second);  // stops and joins the one it replaces
  EXPECT_EQ(ended, 1);
  EXPECT_TRUE(first.joinable());
  first.requestStop();
  first.join();
  first.join();
  EXPECT_EQ(ended, 2);
  EXPECT_FALSE(first.joinable());
}

TEST(RingedThread, WakesABodyThatWaitsForItsBellAndEndsIt) {
  rt::Doorbell bell;
  std::atomic<int> ended{0};
  const auto wait_for_bell = [&](const std::stop_token& stop) {
    while (!stop.stop_requested()) (void)bell.waitUntil(rt::now() + std::chrono::hours(1));
    ++ended;
  };
  {
    rt::RingedThread thread(bell);
    thread.stop();
    EXPECT_EQ(ended, 0) << "nothing was started";
    thread.thread() = mustStart({.name = "ringed"}, wait_for_bell);
    thread.stop();
    EXPECT_EQ(ended, 1);
    thread.stop();
    thread.thread() = mustStart({.name = "ringed"}, wait_for_bell);
  }
  EXPECT_EQ(ended, 2) << "the destructor rings, too";
}

TEST(Thread, ConfiguresThreadsThatALibraryMade) {
  rt::TaskInfo seen;
  rt::Result<rt::ThreadGrant> grant;
  std::jthread library([&] {
    grant = rt::applyToCurrentThread(
        {.name = "adopted", .policy = SchedPolicy::kRoundRobin, .priority = 1});
    seen = self();
  });
  library.join();
  ASSERT_TRUE(grant.has_value());
  EXPECT_EQ(seen.name, "adopted");
  EXPECT_EQ(seen.policy, grant->realtime ? SchedPolicy::kRoundRobin : SchedPolicy::kOther);
}

TEST(ListTasks, ShowsEveryThreadOfTheProcessOnce) {
  auto thread = mustStart({.name = "listed"}, [](const std::stop_token& stop) {
    while (!stop.stop_requested()) sched_yield();
  });
  const auto tasks = rt::listTasks();
  EXPECT_EQ(std::ranges::count(tasks, std::string("listed"), &rt::TaskInfo::name), 1);
  EXPECT_EQ(std::ranges::count(tasks, gettid(), &rt::TaskInfo::tid), 1);
}

}  // namespace

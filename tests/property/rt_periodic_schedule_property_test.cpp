
#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "rt/periodic_loop.h"

namespace {

using rt::Nanoseconds;

/// A thread that always wakes a little late and works for a random time, however long.
RC_GTEST_PROP(PeriodicScheduleProperty, ServesOrCountsEveryDeadlineAndNeverBursts, ()) {
  const auto period = Nanoseconds(*rc::gen::inRange(1'000, 100'000));
  const auto max_lateness = Nanoseconds(*rc::gen::inRange<std::int64_t>(0, period.count()));
  const auto first = rt::fromNs(1'000'000);
  rt::PeriodicSchedule schedule(first, period, max_lateness);

  auto now = first;
  std::uint64_t served = 0;
  std::uint64_t reported = 0;
  rt::Timestamp last_turn;  // long before the first deadline
  const auto cycles = *rc::gen::inRange(1, 200);
  for (int i = 0; i < cycles; ++i) {
    now = std::max(now, schedule.deadline()) +
          Nanoseconds(*rc::gen::inRange<std::int64_t>(0, period.count() / 4));
    const auto tick = schedule.wake(now);
    RC_ASSERT(schedule.deadline() > now);
    RC_ASSERT((schedule.deadline() - first) % period == Nanoseconds{0});
    if (tick) {
      ++served;
      reported += tick->missed;
      RC_ASSERT(tick->deadline == first + static_cast<std::int64_t>(tick->index) * period);
      RC_ASSERT(tick->deadline + tick->lateness == now);
      RC_ASSERT(tick->lateness >= Nanoseconds{0} && tick->lateness <= max_lateness);
      RC_ASSERT(tick->lateness < period);
      RC_ASSERT(now - last_turn >= period - max_lateness);
      RC_ASSERT(reported + served == tick->index + 1);
      last_turn = now;
    }
    now += Nanoseconds(*rc::gen::inRange<std::int64_t>(0, 4 * period.count()));
  }
  const auto deadlines_passed = (schedule.deadline() - first) / period;
  RC_ASSERT(served + schedule.missed() == static_cast<std::uint64_t>(deadlines_passed));
}

}  // namespace

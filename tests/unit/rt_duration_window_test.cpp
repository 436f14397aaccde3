#include <stop_token>
#include <thread>

#include <gtest/gtest.h>

#include "rt/counter.h"
#include "rt/duration_window.h"

namespace {

using rt::DurationSummary;
using rt::DurationWindow;
using rt::Nanoseconds;

TEST(Counter, CountsFromZero) {
  rt::Counter counter;
  EXPECT_EQ(counter.value(), 0u);
  counter.add();
  counter.add(4);
  EXPECT_EQ(counter.value(), 5u);
  counter.raiseTo(9);
  EXPECT_EQ(counter.value(), 9u);
}

TEST(DurationWindow, IsAllZeroBeforeAnything) {
  EXPECT_EQ(DurationWindow().summary(), DurationSummary{});
}

TEST(DurationWindow, GivesQuantilesByNearestRank) {
  DurationWindow window;
  for (int ns = 100; ns >= 1; --ns) window.add(Nanoseconds{ns});
  EXPECT_EQ(window.summary(), (DurationSummary{.count = 100,
                                               .p50 = Nanoseconds{50},
                                               .p95 = Nanoseconds{95},
                                               .longest = Nanoseconds{100},
                                               .longest_ever = Nanoseconds{100}}));
}

TEST(DurationWindow, IsTheOneDurationThatThereIs) {
  DurationWindow window;
  window.add(Nanoseconds{7});
  EXPECT_EQ(window.summary().p50, Nanoseconds{7});
  EXPECT_EQ(window.summary().p95, Nanoseconds{7});
}

TEST(DurationWindow, ForgetsAllButTheLastAndTheLongestEver) {
  DurationWindow window;
  window.add(Nanoseconds{5000});
  for (std::size_t i = 0; i < DurationWindow::kKept; ++i) window.add(Nanoseconds{3});
  EXPECT_EQ(window.summary(), (DurationSummary{.count = DurationWindow::kKept + 1,
                                               .p50 = Nanoseconds{3},
                                               .p95 = Nanoseconds{3},
                                               .longest = Nanoseconds{3},
                                               .longest_ever = Nanoseconds{5000}}));
}

TEST(DurationWindow, IsReadWhileItIsWritten) {
  DurationWindow window;
  std::jthread writer([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) window.add(Nanoseconds{20});
  });
  for (int i = 0; i < 1000; ++i) {
    const DurationSummary summary = window.summary();
    if (summary.count == 0) continue;
    ASSERT_EQ(summary.p50, Nanoseconds{20});
    ASSERT_EQ(summary.longest_ever, Nanoseconds{20});
  }
}

}  // namespace

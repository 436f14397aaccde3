#include "appliance/render/render_metrics.h"

#include <optional>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using appliance::RenderMetrics;

constexpr rt::Nanoseconds kVblank = 10ms;
constexpr rt::Nanoseconds kMargin = 1ms;

/// The vblanks of a screen of 100 Hz, one of them at the epoch.
const std::optional<hal::DisplayTiming> kTiming =
    hal::DisplayTiming{.vblank = 0, .period_ns = 1e7, .commit_margin = kMargin};

rt::Timestamp at(rt::Nanoseconds time) {
  return rt::Timestamp(time);
}

/// Pictures that are committed and come on screen, in their order.
struct Screen {
  void commit(rt::Nanoseconds when, const std::optional<hal::DisplayTiming>& timing = kTiming) {
    metrics.committed(++committed, at(when), timing);
  }
  void flip(rt::Nanoseconds when) {
    ++flipped;
    metrics.flipped({.picture_id = flipped, .page_flip = at(when), .vblank = 0});
  }
  RenderMetrics metrics;
  std::uint64_t committed = 0;
  std::uint64_t flipped = 0;
};

TEST(RenderMetrics, AFlipAtTheNextVblankIsInTimeAndOneAfterItIsLate) {
  Screen screen;
  screen.commit(12ms);
  screen.flip(20ms);
  EXPECT_EQ(screen.metrics.flips_late.value(), 0u);
  screen.commit(22ms);
  screen.flip(40ms);
  EXPECT_EQ(screen.metrics.flips_late.value(), 1u);
  screen.commit(42ms);
  screen.flip(50ms);
  EXPECT_EQ(screen.metrics.flips_late.value(), 1u);
  EXPECT_EQ(screen.metrics.flips.value(), 3u);
}

TEST(RenderMetrics, ACommitTooNearToAVblankIsMeantForTheNextOne) {
  Screen screen;
  screen.commit(20ms - kMargin / 2);
  screen.flip(30ms);
  EXPECT_EQ(screen.metrics.flips_late.value(), 0u);
  screen.commit(40ms - kMargin / 2);
  screen.flip(50ms + kVblank);
  EXPECT_EQ(screen.metrics.flips_late.value(), 1u);
}

TEST(RenderMetrics, APictureThatWaitsBehindAnotherIsInTimeAVblankAfterIt) {
  Screen screen;
  screen.commit(11ms);
  screen.commit(15ms);
  screen.flip(20ms);
  screen.flip(30ms);
  EXPECT_EQ(screen.metrics.flips_late.value(), 0u);
}

TEST(RenderMetrics, WithoutKnownVblanksNothingCountsAsLate) {
  Screen screen;
  screen.commit(12ms, std::nullopt);
  screen.flip(12ms + 10 * kVblank);
  EXPECT_EQ(screen.metrics.flips_late.value(), 0u);
  EXPECT_EQ(screen.metrics.flips.value(), 1u);
}

}  // namespace

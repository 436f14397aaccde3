#include <gtest/gtest.h>

#include "ui-kms/flip_grid.h"

namespace {

using rt::fromNs;
using ui::FlipGrid;

TEST(FlipGrid, AnInstantOnAVblankWaitsForTheNextOne) {
  const FlipGrid grid(fromNs(1'000), 100);  // 10 ms
  EXPECT_EQ(grid.firstAfter(fromNs(1'000)), 1U);
  EXPECT_EQ(grid.firstAfter(fromNs(10'000'999)), 1U);
  EXPECT_EQ(grid.firstAfter(fromNs(10'001'000)), 2U);
}

TEST(FlipGrid, BeforeTheEpochTheFirstVblankIsNext) {
  const FlipGrid grid(fromNs(5'000'000), 60);
  EXPECT_EQ(grid.firstAfter(fromNs(4'999'999)), 0U);
}

TEST(FlipGrid, DoesNotDriftOverADay) {
  const FlipGrid grid(fromNs(0), 60);
  constexpr std::uint64_t kDay = 60ULL * 86'400;
  EXPECT_EQ(grid.at(kDay), fromNs(86'400LL * 1'000'000'000));
}

TEST(FlipGrid, EveryVblankComesAfterTheOneBeforeAndOnlyOneIsFirst) {
  const FlipGrid grid(fromNs(123'456'789), 59.94);
  for (std::uint64_t vblank = 0; vblank < 200'000; vblank += 7) {
    const rt::Timestamp at = grid.at(vblank);
    ASSERT_EQ(grid.firstAfter(at), vblank + 1);
    ASSERT_EQ(grid.firstAfter(at - rt::Nanoseconds(1)), vblank);
  }
}

}  // namespace

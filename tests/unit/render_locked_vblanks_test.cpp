#include <chrono>

#include <gtest/gtest.h>

#include "appliance/render/locked_vblanks.h"

namespace {

using appliance::GenlockState;
using appliance::GenlockStatus;
using appliance::LockedVblanks;
using namespace std::chrono_literals;

constexpr rt::Timestamp kVblank = rt::fromNs(500'000'000'000);  // number 1000

LockedVblanks locked(std::uint32_t vblanks_per_trigger, rt::Nanoseconds draw = 4ms) {
  const hal::DisplayTiming timing{.vblank = 1000,
                                  .at = kVblank,
                                  .period_ns = 10e6,
                                  .stamp_jitter_ns = 0,
                                  .draw = draw,
                                  .commit_margin = 1ms};
  return {timing, GenlockStatus{.state = GenlockState::kLocked,
                                .vblanks_per_trigger = vblanks_per_trigger,
                                .lead = 23ms}};
}

TEST(LockedVblanks, GiveEveryTriggerItsVblankWhateverTheEdgesJitter) {
  const LockedVblanks vblanks = locked(2);
  for (const rt::Nanoseconds late : {-3ms, 0ms, 4ms})
    EXPECT_EQ(vblanks.of(kVblank - 23ms + late), 1000u) << late.count();
  EXPECT_EQ(vblanks.of(kVblank - 3ms), 1002u);
}

TEST(LockedVblanks, HoldAPictureThatIsAWholeVblankEarly) {
  const LockedVblanks vblanks = locked(2);
  const rt::Timestamp edge = kVblank - 23ms;
  EXPECT_GT(vblanks.earliestCommit(edge), kVblank - 10ms);
  EXPECT_LT(vblanks.earliestCommit(edge), kVblank - 9ms);
}

TEST(LockedVblanks, LetARedrawComeBetweenTwoPictures) {
  const LockedVblanks vblanks = locked(2);
  const rt::Timestamp edge = kVblank - 23ms;  // on screen at kVblank, the next one 20 ms later
  EXPECT_TRUE(vblanks.redrawFits(kVblank + 1ms, edge));
  EXPECT_TRUE(vblanks.redrawFits(kVblank + 4ms, edge));
  EXPECT_FALSE(vblanks.redrawFits(kVblank + 6ms, edge)) << "with the next picture's vblank";
  EXPECT_FALSE(vblanks.redrawFits(kVblank + 19ms, edge));
}

TEST(LockedVblanks, LeaveEveryVblankToTheFramesWhereThereAreNoMore) {
  const LockedVblanks vblanks = locked(1);
  for (rt::Nanoseconds t = 0ms; t <= 10ms; t += 1ms)
    EXPECT_FALSE(vblanks.redrawFits(kVblank + t, kVblank - 23ms)) << t.count();
}

TEST(LockedVblanks, LetARedrawComeWhenTheNextFrameDoesNot) {
  EXPECT_TRUE(locked(1).redrawFits(kVblank + 10ms + 1us, kVblank - 23ms));
  EXPECT_TRUE(locked(2).redrawFits(kVblank + 20ms + 1us, kVblank - 23ms));
}

}  // namespace

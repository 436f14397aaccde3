#include <gtest/gtest.h>

#include "appliance/capture/frame_set.h"

namespace {

using appliance::FrameSetBoard;

TEST(FrameSetBoard, TellsTheArrivalThatCompletesTheSet) {
  FrameSetBoard sets{3};
  EXPECT_FALSE(sets.arrived(7));
  EXPECT_FALSE(sets.arrived(7));
  EXPECT_TRUE(sets.arrived(7));
}

TEST(FrameSetBoard, CountsInterleavedTriggersApart) {
  FrameSetBoard sets{2};
  EXPECT_FALSE(sets.arrived(1));
  EXPECT_FALSE(sets.arrived(2));
  EXPECT_TRUE(sets.arrived(1));
  EXPECT_TRUE(sets.arrived(2));
}

TEST(FrameSetBoard, LeavesASetIncompleteWhenACameraMissedIt) {
  FrameSetBoard sets{2};
  EXPECT_FALSE(sets.arrived(1));
  for (std::uint64_t trigger = 2; trigger < 2000; ++trigger) {
    EXPECT_FALSE(sets.arrived(trigger));
    EXPECT_TRUE(sets.arrived(trigger));
  }
}

TEST(FrameSetBoard, IgnoresAFrameLaterThanItsMemory) {
  FrameSetBoard sets{2};
  EXPECT_FALSE(sets.arrived(1000));
  EXPECT_FALSE(sets.arrived(1000 - 256));
  EXPECT_TRUE(sets.arrived(1000)) << "the late one did not disturb the newer set";
}

}  // namespace

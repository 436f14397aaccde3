#include "appliance/capture/large_packets.h"

#include <gtest/gtest.h>

namespace {

using appliance::LargePacketWatch;
using hal::CameraStatistics;

constexpr std::uint32_t kPackets = 149;

TEST(LargePacketWatch, SeesThatOnlyTheSmallPacketsOfEveryFrameCome) {
  LargePacketWatch watch(kPackets);
  EXPECT_FALSE(watch.vanish({.frames_complete = 1000}));
  EXPECT_FALSE(watch.vanish(
      {.frames_complete = 1000, .frames_incomplete = 2, .packets_missing = 2 * (kPackets - 1)}));
  EXPECT_TRUE(watch.vanish(
      {.frames_complete = 1000, .frames_incomplete = 3, .packets_missing = 3 * (kPackets - 1)}));
}

TEST(LargePacketWatch, TakesOrdinaryLossForWhatItIs) {
  LargePacketWatch watch(kPackets);
  EXPECT_FALSE(watch.vanish({.frames_incomplete = 10, .packets_missing = 700}));
  EXPECT_FALSE(watch.vanish({.frames_complete = 1, .frames_incomplete = 20}));
}

TEST(LargePacketWatch, IsSatisfiedByOneCompleteFrame) {
  LargePacketWatch watch(kPackets);
  CameraStatistics counts{.frames_incomplete = 5, .packets_missing = 5 * (kPackets - 1)};
  EXPECT_TRUE(watch.vanish(counts));
  ++counts.frames_complete;
  EXPECT_FALSE(watch.vanish(counts));
  EXPECT_FALSE(watch.vanish(counts)) << "nothing new";
}

TEST(LargePacketWatch, StartsAgainWithTheStream) {
  LargePacketWatch watch(kPackets);
  EXPECT_TRUE(watch.vanish({.frames_incomplete = 5, .packets_missing = 5 * (kPackets - 1)}));
  EXPECT_FALSE(watch.vanish({}));
  EXPECT_FALSE(watch.vanish({.frames_incomplete = 2, .packets_missing = 2 * (kPackets - 1)}));
}

}  // namespace

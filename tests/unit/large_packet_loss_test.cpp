#include "appliance/capture/large_packet_loss.h"

#include <gtest/gtest.h>

namespace {

using appliance::LargePacketLoss;
using hal::CameraStatistics;

constexpr std::uint32_t kPackets = 149;

TEST(LargePacketLoss, SeesThatOnlyTheSmallPacketsOfEveryFrameCome) {
  LargePacketLoss watch(kPackets);
  EXPECT_FALSE(watch.update({.frames_complete = 1000}));
  EXPECT_FALSE(watch.update(
      {.frames_complete = 1000, .frames_incomplete = 2, .packets_missing = 2 * (kPackets - 1)}));
  EXPECT_TRUE(watch.update(
      {.frames_complete = 1000, .frames_incomplete = 3, .packets_missing = 3 * (kPackets - 1)}));
}

TEST(LargePacketLoss, TakesOrdinaryLossForWhatItIs) {
  LargePacketLoss watch(kPackets);
  EXPECT_FALSE(watch.update({.frames_incomplete = 10, .packets_missing = 700}));
  EXPECT_FALSE(watch.update({.frames_complete = 1, .frames_incomplete = 20}));
}

TEST(LargePacketLoss, IsSatisfiedByOneCompleteFrame) {
  LargePacketLoss watch(kPackets);
  CameraStatistics counts{.frames_incomplete = 5, .packets_missing = 5 * (kPackets - 1)};
  EXPECT_TRUE(watch.update(counts));
  ++counts.frames_complete;
  EXPECT_FALSE(watch.update(counts));
  EXPECT_FALSE(watch.update(counts)) << "nothing new";
}

TEST(LargePacketLoss, StartsAgainWithTheStream) {
  LargePacketLoss watch(kPackets);
  EXPECT_TRUE(watch.update({.frames_incomplete = 5, .packets_missing = 5 * (kPackets - 1)}));
  EXPECT_FALSE(watch.update({}));
  EXPECT_FALSE(watch.update({.frames_incomplete = 2, .packets_missing = 2 * (kPackets - 1)}));
}

}  // namespace

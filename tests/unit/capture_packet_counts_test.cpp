#include <gtest/gtest.h>

#include "appliance/capture/packet_counts.h"

namespace {

using appliance::PacketCounts;

TEST(PacketCounts, FollowTheCamera) {
  PacketCounts counts;
  counts.take({.packets_resent = 5, .packets_missing = 1, .underruns = 0});
  counts.take({.packets_resent = 9, .packets_missing = 1, .underruns = 2});
  EXPECT_EQ(counts.resent.value(), 9u);
  EXPECT_EQ(counts.missing.value(), 1u);
  EXPECT_EQ(counts.underruns.value(), 2u);
}

TEST(PacketCounts, GoOnWhenTheCameraIsStartedAgain) {
  PacketCounts counts;
  counts.take({.packets_resent = 9, .packets_missing = 4, .underruns = 2});
  counts.take({.packets_resent = 3, .packets_missing = 0, .underruns = 2});
  EXPECT_EQ(counts.resent.value(), 12u);
  EXPECT_EQ(counts.missing.value(), 4u);
}

}  // namespace

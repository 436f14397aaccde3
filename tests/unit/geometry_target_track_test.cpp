#include <thread>

#include <gtest/gtest.h>

#include "appliance/geometry/target_track.h"

namespace {

using appliance::TargetPoint;
using appliance::TargetTrack;

TEST(TargetTrack, HoldsTheInitialPointUntilAnotherIsSet) {
  TargetTrack track({1, 2, 3});
  EXPECT_EQ(track.at(rt::fromNs(5)).vector(), Eigen::Vector3d(1, 2, 3));
  track.set({4, 5, 6});
  EXPECT_EQ(track.at(rt::fromNs(5)).vector(), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(track.at(rt::fromNs(1)).vector(), Eigen::Vector3d(4, 5, 6));
}

TEST(TargetTrack, IsNeverReadHalfWritten) {
  constexpr int kCount = 100'000;
  TargetTrack track({0, 0, 0});
  std::jthread control([&] {
    for (int i = 1; i <= kCount; ++i) track.set({1.0 * i, 2.0 * i, 3.0 * i});
  });
  int torn = 0;
  TargetPoint last;
  while (last.x_m < kCount) {
    const TargetPoint point = track.at({});
    if (point.y_m != 2 * point.x_m || point.z_m != 3 * point.x_m || point.x_m < last.x_m) ++torn;
    last = point;
  }
  EXPECT_EQ(torn, 0);
}

}  // namespace

#include <gtest/gtest.h>

#include "appliance/capture/arrival_filter.h"

namespace {

using namespace std::chrono_literals;
using appliance::ArrivalFilter;

constexpr rt::Nanoseconds kPeriod = 25ms;
constexpr rt::Nanoseconds kClockOffset = 1234s;  // the camera was switched on some time ago

/// A camera that sends every 25 ms, and a machine that looks some time after.
class ArrivalFilterTest : public testing::Test {
 protected:
  /// How late the filter believes the leader came, when the machine looked @p late.
  rt::Nanoseconds believed(rt::Nanoseconds late) {
    true_arrival_ += kPeriod;
    camera_clock_ += kPeriod + drift_;
    return filter_.arrival(true_arrival_ + late, camera_clock_) - true_arrival_;
  }
  void settle(int frames = 20) {
    for (int i = 0; i < frames; ++i) (void)believed(100us);
  }

  ArrivalFilter filter_;
  rt::Timestamp true_arrival_ = rt::fromNs(5'000'000'000'000);
  rt::Nanoseconds camera_clock_ = kClockOffset;
  rt::Nanoseconds drift_{0};
};

TEST_F(ArrivalFilterTest, RemovesTheLatenessOfABusyMachine) {
  settle();
  EXPECT_EQ(believed(20ms), 100us);
  EXPECT_EQ(believed(40ms), 100us);
  EXPECT_EQ(believed(300us), 100us);
}

TEST_F(ArrivalFilterTest, ForgetsAFirstFrameThatCameLate) {
  EXPECT_EQ(believed(42ms), 42ms) << "nothing else is known yet";
  EXPECT_EQ(believed(200us), 200us);
  EXPECT_EQ(believed(17ms), 200us);
}

TEST_F(ArrivalFilterTest, FollowsAClockThatDrifts) {
  for (const rt::Nanoseconds drift : {2500ns, -2500ns}) {  // 100 ppm either way
    drift_ = drift;
    for (int i = 0; i < 4000; ++i) {
      const rt::Nanoseconds error = believed(i % 3 == 0 ? 100us : 8ms) - 100us;
      ASSERT_LT(std::chrono::abs(error), 500us) << i;
    }
  }
}

TEST_F(ArrivalFilterTest, FollowsAClockThatWasSetForwardAtOnce) {
  settle();
  camera_clock_ += 10s;
  EXPECT_EQ(believed(150us), 150us);
}

TEST_F(ArrivalFilterTest, FollowsAClockThatWasSetBackAfterTwoWindows) {
  settle();
  camera_clock_ -= 100ms;
  settle(2 * static_cast<int>(ArrivalFilter::kWindow / kPeriod) + 2);
  EXPECT_EQ(believed(9ms), 100us);
}

TEST_F(ArrivalFilterTest, StartsAnewAfterALongSilence) {
  settle();
  true_arrival_ += 60s;
  camera_clock_ = 1s;  // it was switched off and on
  EXPECT_EQ(believed(3ms), 3ms);
  EXPECT_EQ(believed(100us), 100us);
}

TEST_F(ArrivalFilterTest, TakesTheStampWhereTheCameraHasNoClock) {
  EXPECT_EQ(filter_.arrival(rt::fromNs(77), 0ns), rt::fromNs(77));
}

}  // namespace

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/geometry/target_track.h"

namespace {

using appliance::HandTargets;
using appliance::looksDifferent;
using appliance::Target;
using appliance::TargetOrigin;
using appliance::TargetPoint;
using appliance::TargetReader;
using appliance::TargetTrack;
using namespace std::chrono_literals;

constexpr TargetPoint kRigPoint{1, 2, 3};
constexpr TargetPoint kByHand{4, 5, 6};

rt::Timestamp at(rt::Nanoseconds since_start) {
  return rt::fromNs(1'000'000'000) + since_start;
}

/// Reads with kRigPoint for want of anything better.
class Reader {
 public:
  explicit Reader(const TargetTrack& track) : reader_(track) {}
  Target at(rt::Timestamp instant) { return reader_.at(instant, kRigPoint); }

 private:
  TargetReader reader_;
};

/// Measured at 30 Hz from at(0) on, walking along x with one metre a second.
void walk(TargetTrack& track, int measurements) {
  for (int i = 0; i < measurements; ++i)
    ASSERT_TRUE(track.measure(at(i * 33ms), {0.033 * i, 0, 1}, 0.8));
}

TEST(TargetTrack, TakesTheRigsPointUntilAnythingElseIsKnown) {
  const TargetTrack track;
  TargetReader reader(track);
  const Target first = reader.at(at(5s), kRigPoint);
  EXPECT_EQ(first.point, kRigPoint);
  EXPECT_EQ(first.origin, TargetOrigin::kRig);
  EXPECT_EQ(reader.at({}, kRigPoint).point, kRigPoint) << "an exposure that is not known";
  EXPECT_TRUE(looksDifferent(first, reader.at(at(5s), {0, 0, 1}))) << "another rig was taken";
  EXPECT_FALSE(looksDifferent(first, reader.at(at(5s), kRigPoint)));
}

TEST(TargetTrack, KeepsAPointThatWasSetBeforeAnyRig) {
  TargetTrack track;
  track.setByHand(kByHand, at(0s));
  TargetReader reader(track);
  EXPECT_EQ(reader.at({}, {}).point, kByHand);
}

TEST(TargetTrack, APointSetByHandHoldsFromItsMomentOn) {
  TargetTrack track;
  walk(track, 90);
  Reader reader(track);
  track.setByHand(kByHand, at(1s));
  EXPECT_EQ(reader.at(at(1s) - 1ns).origin, TargetOrigin::kMeasured);
  EXPECT_EQ(reader.at(at(1s)).point, kByHand);
  EXPECT_EQ(reader.at(at(1h)).origin, TargetOrigin::kByHand);
  EXPECT_EQ(reader.at({}).point, kByHand);
}

TEST(TargetTrack, APointSetByHandServesEarlierMomentsOfWhichNothingIsKnown) {
  TargetTrack track;
  Reader reader(track);
  track.setByHand(kByHand, at(10s));
  EXPECT_EQ(reader.at(at(1s)).point, kByHand);
  track.release(at(11s));
  EXPECT_EQ(reader.at(at(1s)).point, kRigPoint);
}

TEST(TargetTrack, AReleasedPointKeepsItsRangeAndMeasurementsFollow) {
  TargetTrack track;
  walk(track, 90);
  Reader reader(track);
  track.setByHand(kByHand, at(1s));
  track.release(at(2s));
  EXPECT_EQ(reader.at(at(1500ms)).point, kByHand);
  EXPECT_EQ(reader.at(at(2s)).origin, TargetOrigin::kMeasured);
  EXPECT_EQ(reader.at({}).origin, TargetOrigin::kMeasured);
}

TEST(TargetTrack, AReleaseAtAnEarlierMomentTakesThePointBackAltogether) {
  TargetTrack track;
  walk(track, 90);
  Reader reader(track);
  track.setByHand(kByHand, at(1s));
  track.release(at(500ms));
  EXPECT_EQ(reader.at(at(1500ms)).origin, TargetOrigin::kMeasured);
}

TEST(TargetTrack, TheLaterOfTwoPointsSetByHandWinsFromItsMomentOn) {
  TargetTrack track;
  Reader reader(track);
  track.setByHand({1, 0, 0}, at(1s));
  track.setByHand({2, 0, 0}, at(2s));
  EXPECT_EQ(reader.at(at(1500ms)).point.x_m, 1);
  EXPECT_EQ(reader.at(at(2500ms)).point.x_m, 2);
  track.setByHand({3, 0, 0}, at(1200ms));  // a person went back to an earlier moment
  EXPECT_EQ(reader.at(at(1100ms)).point.x_m, 1);
  EXPECT_EQ(reader.at(at(1500ms)).point.x_m, 3);
  EXPECT_EQ(reader.at(at(2500ms)).point.x_m, 3);
}

TEST(TargetTrack, ForgetsTheOldestOfManyPointsSetByHand) {
  TargetTrack track;
  Reader reader(track);
  for (int i = 0; i <= static_cast<int>(HandTargets::kMost); ++i)
    track.setByHand({1.0 * i, 0, 0}, at(i * 1s));
  EXPECT_EQ(reader.at(at(1500ms)).point.x_m, 1);
  EXPECT_EQ(reader.at(at(500ms)).point.x_m, HandTargets::kMost) << "the open one serves it";
}

TEST(TargetTrack, SaysWhatItMeasuredBetweenTwoMeasurements) {
  TargetTrack track;
  walk(track, 10);
  Reader reader(track);
  const Target target = reader.at(at(33ms * 3 + 11ms));
  EXPECT_EQ(target.origin, TargetOrigin::kMeasured);
  EXPECT_NEAR(target.point.x_m, 0.110, 1e-9);
  EXPECT_DOUBLE_EQ(target.confidence, 0.8);
  EXPECT_EQ(reader.at(at(33ms * 9)).origin, TargetOrigin::kMeasured) << "the newest itself";
}

TEST(TargetTrack, PredictsAMovementForAWhileThenStands) {
  TargetTrack track;
  walk(track, 10);
  Reader reader(track);
  const rt::Timestamp newest = at(33ms * 9);
  const Target soon = reader.at(newest + 100ms);
  EXPECT_EQ(soon.origin, TargetOrigin::kPredicted);
  EXPECT_NEAR(soon.point.x_m, 0.297 + 0.1, 1e-6);
  EXPECT_LT(soon.confidence, 0.8);
  EXPECT_EQ(reader.at(newest + 200ms).point, reader.at(newest + 1h).point);
  EXPECT_EQ(reader.at(newest + 1h).confidence, 0);
}

TEST(TargetTrack, NeverPredictsFartherThanHalfAMetre) {
  TargetTrack track;
  ASSERT_TRUE(track.measure(at(0ms), {0, 0, 1}, 1));
  ASSERT_TRUE(track.measure(at(33ms), {1, 0, 1}, 1));  // 30 m/s: a slip of the measurement
  Reader reader(track);
  EXPECT_NEAR(reader.at(at(133ms)).point.x_m, 1.5, 1e-9);
}

TEST(TargetTrack, CallsThePointInALongGapPredicted) {
  TargetTrack track;
  ASSERT_TRUE(track.measure(at(0s), {0, 0, 1}, 1));
  ASSERT_TRUE(track.measure(at(5s), {1, 0, 1}, 1));
  Reader reader(track);
  const Target target = reader.at(at(1s));
  EXPECT_EQ(target.origin, TargetOrigin::kPredicted);
  EXPECT_NEAR(target.point.x_m, 0.2, 1e-9);
  EXPECT_LT(target.confidence, 0.2);
}

TEST(TargetTrack, RefusesAndCountsWhatIsNotNewerOrNotANumber) {
  TargetTrack track;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(track.measure({}, {0, 0, 1}, 1)) << "the epoch is no instant";
  EXPECT_TRUE(track.measure(at(1s), {0, 0, 1}, 1));
  EXPECT_FALSE(track.measure(at(1s), {0, 0, 1}, 1));
  EXPECT_FALSE(track.measure(at(2s), {nan, 0, 1}, 1));
  EXPECT_FALSE(track.measure(at(2s), {0, 0, 1}, nan));
  EXPECT_FALSE(track.revise(at(500ms), {0, 0, 1}, 1)) << "nothing was measured then";
  EXPECT_EQ(track.refused(), 5u);
}

TEST(TargetTrack, ARevisedPastIsDrawnAgainOnlyBeyondTheDeadBand) {
  TargetTrack track;
  walk(track, 30);
  Reader reader(track);
  const rt::Timestamp stopped = at(33ms * 10);
  const Target shown = reader.at(stopped);
  EXPECT_FALSE(looksDifferent(shown, reader.at(stopped)));
  for (const double shift_m : {0.002, 0.004}) {
    ASSERT_TRUE(track.revise(stopped, {0.33 + shift_m, 0, 1}, 0.9));
    EXPECT_GT(reader.at(stopped).revision, shown.revision);
    EXPECT_FALSE(looksDifferent(shown, reader.at(stopped))) << shift_m;
  }
  ASSERT_TRUE(track.revise(stopped, {0.336, 0, 1}, 0.9));
  EXPECT_TRUE(looksDifferent(shown, reader.at(stopped)));
  EXPECT_EQ(reader.at(stopped).confidence, 0.9);
}

TEST(TargetTrack, ASmallStepByHandIsDrawn) {
  TargetTrack track;
  Reader reader(track);
  track.setByHand(kByHand, at(1s));
  const Target shown = reader.at(at(1s));
  track.setByHand({4.001, 5, 6}, at(1s));
  EXPECT_TRUE(looksDifferent(shown, reader.at(at(1s))));
}

TEST(TargetTrack, ForgetsWhatIsOlderThanItsCapacity) {
  TargetTrack track;
  Reader reader(track);
  const int count = static_cast<int>(TargetTrack::kCapacity) + 500;
  for (int i = 0; i < count; ++i) ASSERT_TRUE(track.measure(at(i * 10ms), {1.0 * i, 0, 1}, 1));
  EXPECT_EQ(reader.at(at(100 * 10ms)).origin, TargetOrigin::kRig);
  EXPECT_EQ(reader.at(at((count - 1) * 10ms)).point.x_m, count - 1);
  EXPECT_EQ(reader.at(at(1000 * 10ms)).point.x_m, 1000);
}

TEST(TargetTrack, NoReaderEverSeesHalfOfAPoint) {
  constexpr int kReaders = 2;
  constexpr int kLooks = 20'000;
  TargetTrack track;
  std::atomic<int> done{0};
  std::array<int, kReaders> torn{};
  {
    std::vector<std::jthread> readers;
    for (int r = 0; r < kReaders; ++r) {
      readers.emplace_back([&track, &done, &torn = torn[static_cast<std::size_t>(r)], r] {
        Reader reader(track);
        for (int i = 0; i < kLooks; ++i) {
          const auto back = rt::Nanoseconds((i * 37 + r) % 3000);
          const Target target =
              reader.at(reader.at({}).origin == TargetOrigin::kRig ? rt::Timestamp{}
                                                                   : rt::fromNs(1'000 + i) - back);
          const auto& [x, y, z] = target.point;
          const bool whole = target.origin == TargetOrigin::kRig
                                 ? target.point == kRigPoint
                                 : std::abs(y - 2 * x) < 1e-6 && std::abs(z - 3 * x) < 1e-6;
          if (!whole) ++torn;
        }
        ++done;
      });
    }
    for (int i = 1; done < kReaders; ++i) {
      const double x = i % 997;
      (void)track.measure(rt::fromNs(i), {x, 2 * x, 3 * x}, 1);
      (void)track.revise(rt::fromNs(i - 5), {x, 2 * x, 3 * x}, 1);
      if (i % 16 == 0) track.setByHand({x, 2 * x, 3 * x}, rt::fromNs(i - 8));
      if (i % 16 == 8) track.release(rt::fromNs(i));
      if (i % 256 == 0) std::this_thread::yield();
    }
  }
  for (const int count : torn) EXPECT_EQ(count, 0);
}

}  // namespace

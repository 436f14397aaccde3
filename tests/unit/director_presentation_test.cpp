#include <chrono>

#include <gtest/gtest.h>

#include "appliance/director/presentation.h"

namespace {

using appliance::nextMovingPicture;
using appliance::Presentation;
using appliance::presentationOf;
using std::chrono::microseconds;
using std::chrono::milliseconds;

const rt::Timestamp kVblank = rt::fromNs(1'000'000'000);

hal::DisplayTiming timing() {
  return {.vblank = 77,
          .at = kVblank,
          .period_ns = 10e6,
          .draw = milliseconds(3),
          .commit_margin = milliseconds(1)};
}

TEST(Presentation, IsTheFirstVblankThatThePictureCanReach) {
  EXPECT_EQ(presentationOf(kVblank + milliseconds(5), timing()).at, kVblank + milliseconds(10));
  EXPECT_EQ(presentationOf(kVblank + milliseconds(7), timing()).at, kVblank + milliseconds(20));
  EXPECT_EQ(presentationOf(kVblank, timing()).refresh, milliseconds(10));
}

TEST(Presentation, WithoutVblanksIsAShortTimeAhead) {
  const Presentation picture = presentationOf(kVblank, std::nullopt);
  EXPECT_GT(picture.at, kVblank);
  EXPECT_EQ(picture.refresh, rt::Nanoseconds::zero());
}

TEST(Presentation, IsNotCommittedBeforeTheVblankThatPrecedesItsOwn) {
  const Presentation picture = presentationOf(kVblank + milliseconds(7), timing());
  EXPECT_GT(picture.earliestCommit(), kVblank + milliseconds(10));
  EXPECT_LT(picture.earliestCommit(), kVblank + milliseconds(11));
}

TEST(Presentation, WhatMovesIsDecidedOnceForEveryVblank) {
  rt::Timestamp now = kVblank + milliseconds(3);
  rt::Timestamp last = presentationOf(now, timing()).at;
  for (int i = 0; i < 20; ++i) {
    const auto wake = nextMovingPicture(now, timing());
    ASSERT_TRUE(wake.has_value());
    EXPECT_GT(*wake, now);
    now = *wake + microseconds(i * 50 % 400);  // a wake-up is late now and then
    const rt::Timestamp next = presentationOf(now, timing()).at;
    EXPECT_EQ(next - last, milliseconds(10));
    last = next;
  }
  EXPECT_EQ(nextMovingPicture(now, std::nullopt), std::nullopt);
}

}  // namespace

#include <chrono>

#include <gtest/gtest.h>

#include "hal/openni/restart_pause.h"

namespace {

using hal::openni::RestartPause;
using End = RestartPause::End;
using namespace std::chrono_literals;

TEST(RestartPause, DoublesWithEachFailureUpToHalfAMinute) {
  RestartPause pause;
  for (const rt::Nanoseconds expected :
       {200ms, 400ms, 800ms, 1600ms, 3200ms, 6400ms, 12800ms, 25600ms, 30000ms, 30000ms})
    EXPECT_EQ(pause.next(End::kFailure), expected);
}

TEST(RestartPause, IsShortAgainAfterTenSecondsOfPictures) {
  RestartPause pause;
  for (int i = 0; i < 5; ++i) (void)pause.next(End::kFailure);
  pause.onPicture(rt::fromNs(1));
  pause.onPicture(rt::fromNs(1) + 9s);
  EXPECT_EQ(pause.next(End::kFailure), 6400ms) << "nine seconds prove nothing";
  pause.onPicture(rt::fromNs(1) + 20s);
  EXPECT_EQ(pause.next(End::kFailure), 12800ms) << "another worker's pictures do not count";
  pause.onPicture(rt::fromNs(1) + 30s);
  pause.onPicture(rt::fromNs(1) + 40s);
  EXPECT_EQ(pause.next(End::kFailure), 200ms);
}

TEST(RestartPause, IsNotLengthenedByAPlugThatIsPulled) {
  RestartPause pause;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(pause.next(End::kUnplugged), 200ms);
}

}  // namespace

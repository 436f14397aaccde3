#include "appliance/render/render_allowance.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace {

using appliance::RenderAllowance;
using std::chrono::milliseconds;

const rt::Timestamp kStart = rt::fromNs(1'000'000'000);
constexpr milliseconds kPeriod{25};

TEST(RenderAllowance, TheFirstPictureMayBeginAtOnce) {
  EXPECT_LE(RenderAllowance(0.6, kPeriod).nextBegin(), kStart);
}

TEST(RenderAllowance, PicturesWithinTheShareNeverWait) {
  RenderAllowance allowance(0.6, kPeriod);
  for (int i = 0; i < 1000; ++i) {
    const auto begin = kStart + i * kPeriod;
    ASSERT_LE(allowance.nextBegin(), begin) << "picture " << i;
    allowance.spend(begin, begin + milliseconds(15));
  }
}

TEST(RenderAllowance, OneSlowPictureDoesNotHoldUpTheNext) {
  RenderAllowance allowance(0.6, kPeriod);
  allowance.spend(kStart, kStart + milliseconds(25));
  EXPECT_LE(allowance.nextBegin(), kStart + milliseconds(25));
}

TEST(RenderAllowance, ARendererThatIsAlwaysSlowLeavesTheRest) {
  RenderAllowance allowance(0.6, kPeriod);
  auto now = kStart;
  for (int i = 0; i < 100; ++i) {
    now = std::max(now, allowance.nextBegin());
    allowance.spend(now, now + milliseconds(30));
    now += milliseconds(30);
  }
  const auto busy = 100 * milliseconds(30);
  EXPECT_GE(now - kStart, busy * 10 / 6 - kPeriod - milliseconds(20));
}

TEST(RenderAllowance, NothingIsSavedUpWhileNothingIsShown) {
  RenderAllowance allowance(0.6, kPeriod);
  allowance.spend(kStart, kStart + milliseconds(15));
  const auto later = kStart + std::chrono::hours(1);
  allowance.spend(later, later + milliseconds(60));
  EXPECT_EQ(allowance.nextBegin(), later + milliseconds(100) - kPeriod);
}

}  // namespace

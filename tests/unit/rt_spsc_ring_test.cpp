#include <thread>

#include <gtest/gtest.h>

#include "rt/spsc_ring.h"

namespace {

TEST(SpscRing, RefusesTheNewestWhenFullAndCountsTheLoss) {
  rt::SpscRing<int, 2> ring;
  ASSERT_TRUE(ring.tryPush(1));
  ASSERT_TRUE(ring.tryPush(2));

  EXPECT_FALSE(ring.tryPush(3));
  EXPECT_EQ(ring.dropped(), 1u);
  EXPECT_EQ(ring.tryPop(), 1);  // the oldest survived
}

TEST(SpscRing, DeliversEveryAcceptedValueOnceAndInOrderAcrossThreads) {
  constexpr int kCount = 100'000;
  rt::SpscRing<int, 8> ring;
  std::jthread producer([&] {
    for (int i = 0; i < kCount; ++i)
      while (!ring.tryPush(i)) std::this_thread::yield();
  });
  int outOfOrder = 0;
  for (int expected = 0; expected < kCount;) {
    const auto got = ring.tryPop();
    if (!got)
      std::this_thread::yield();
    else if (*got != expected++)
      ++outOfOrder;
  }
  EXPECT_EQ(outOfOrder, 0);
}

}  // namespace

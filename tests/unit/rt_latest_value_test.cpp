#include <thread>

#include <gtest/gtest.h>

#include "rt/latest_value.h"

namespace {

TEST(LatestValue, HoldsTheInitialValueUntilTheFirstIsPublished) {
  rt::LatestValue<int> value(7);
  EXPECT_EQ(value.latest(), 7);
  EXPECT_FALSE(value.tryTake().has_value());
}

TEST(LatestValue, GivesTheNewestValueOnceAndForgetsOlderOnes) {
  rt::LatestValue<int> value;
  value.publish(1);
  value.publish(2);
  value.publish(3);
  EXPECT_EQ(value.tryTake(), 3);
  EXPECT_FALSE(value.tryTake().has_value());
  EXPECT_EQ(value.latest(), 3);
}

TEST(LatestValue, DoesNotOfferAgainWhatLatestHasShown) {
  rt::LatestValue<int> value;
  value.publish(5);
  EXPECT_EQ(value.latest(), 5);
  EXPECT_FALSE(value.tryTake().has_value());
}

TEST(LatestValue, NeverGoesBackAndNeverTearsAcrossThreads) {
  struct Pair {
    std::uint64_t count = 0;
    std::uint64_t filler[6] = {};
    std::uint64_t inverse = ~std::uint64_t{0};
  };
  constexpr std::uint64_t kCount = 200'000;
  rt::LatestValue<Pair> value;
  std::jthread writer([&] {
    for (std::uint64_t i = 1; i <= kCount; ++i) value.publish({i, {}, ~i});
  });

  std::uint64_t newest = 0;
  bool in_order = true;
  bool whole = true;
  while (newest < kCount) {
    const auto got = value.tryTake();
    if (!got) {
      std::this_thread::yield();
      continue;
    }
    in_order = in_order && got->count > newest;
    whole = whole && got->inverse == ~got->count;
    newest = got->count;
    if (!in_order || !whole) break;
  }
  EXPECT_TRUE(in_order);
  EXPECT_TRUE(whole);
}

}  // namespace

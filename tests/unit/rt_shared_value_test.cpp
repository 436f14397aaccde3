#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "rt/shared_value.h"

namespace {

TEST(SharedValue, ShowsTheLastStoredValueToEveryReaderAgainAndAgain) {
  rt::SharedValue<int> value(3);
  EXPECT_EQ(value.load(), 3);
  value.store(4);
  EXPECT_EQ(value.load(), 4);
  EXPECT_EQ(value.tryLoad(), 4);
}

TEST(SharedValue, CarriesSizesThatAreNoWholeWords) {
  struct Odd {
    char text[13];
  };
  const rt::SharedValue<Odd> value(Odd{"twelve chars"});
  EXPECT_STREQ(value.load().text, "twelve chars");
}

TEST(SharedValue, NeverTearsAndNeverGoesBackForAnyReader) {
  struct Wide {
    std::uint64_t count = 0;
    std::uint64_t squares[5] = {};
  };
  constexpr int kReaders = 3;
  constexpr int kLooksPerReader = 20'000;
  rt::SharedValue<Wide> value;
  std::atomic<int> faults{0};
  std::atomic<int> readers_done{0};
  {
    std::vector<std::jthread> readers;
    for (int r = 0; r < kReaders; ++r) {
      readers.emplace_back([&] {
        std::uint64_t last = 0;
        for (int looks = 0; looks < kLooksPerReader;) {
          const auto got = value.tryLoad();
          if (!got) continue;
          for (const auto square : got->squares) {
            if (square != got->count * got->count) ++faults;
          }
          if (got->count < last) ++faults;
          last = got->count;
          ++looks;
        }
        ++readers_done;
      });
    }
    for (std::uint64_t i = 1; readers_done < kReaders; ++i) {
      const auto q = i * i;
      value.store({i, {q, q, q, q, q}});
      if (i % 64 == 0) std::this_thread::yield();
    }
  }
  EXPECT_EQ(faults, 0);
}

}  // namespace

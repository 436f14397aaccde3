#include "appliance/depth/depth_board.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/depth_lender.h"

namespace {

using appliance::DepthBoard;
using appliance::DepthReader;
using appliance::PinnedDepth;
using Lender = test::DepthLender;
using testing::HasSubstr;
using namespace std::chrono_literals;

DepthReader& readerOf(DepthBoard& board, const std::string& name, std::uint32_t pins) {
  auto reader = board.openReader(name, pins);
  EXPECT_TRUE(reader) << reader.error();
  return **reader;
}

bool holds(const PinnedDepth& pinned, std::uint64_t number) {
  return std::ranges::all_of(
             pinned.depth_mm,
             [&](std::uint16_t mm) { return mm == static_cast<std::uint16_t>(number); }) &&
         std::ranges::all_of(pinned.colour_rgb, [&](std::uint8_t value) {
           return value == static_cast<std::uint8_t>(number);
         });
}

TEST(DepthBoard, IsEmptyBeforeTheFirstPicture) {
  DepthBoard board;
  DepthReader& reader = readerOf(board, "a", 1);
  EXPECT_FALSE(reader.tryNewest());
  EXPECT_FALSE(reader.tryNext());
  EXPECT_EQ(board.newest(), 0u);
}

TEST(DepthBoard, KeepsWhatIsKnownOfBothPictures) {
  DepthBoard board;
  DepthReader& reader = readerOf(board, "a", 1);
  Lender sensor;
  board.publish(sensor.lend(41));
  const auto pinned = reader.tryNewest();
  ASSERT_TRUE(pinned);
  EXPECT_EQ(pinned->picture.number, 1u);
  EXPECT_EQ(pinned->picture.sensor_number, 41u);
  EXPECT_EQ(pinned->picture.exposure, rt::fromNs(41'000));
  EXPECT_EQ(pinned->picture.colour_exposure, rt::fromNs(41'007));
  EXPECT_EQ(pinned->picture.lens.focal_x_px, 570);
  EXPECT_EQ(pinned->picture.colour_lens.distortion[0], 0.1);
  EXPECT_EQ(pinned->depth_mm.size(), 32u);
  EXPECT_TRUE(holds(*pinned, 41));
}

TEST(DepthBoard, TwoReadersOfDifferentSpeedGetEveryAndTheNewestPicture) {
  DepthBoard board;
  DepthReader& every = readerOf(board, "every", 1);
  DepthReader& newest = readerOf(board, "newest", 1);
  Lender sensor;
  std::vector<std::uint64_t> read;
  std::vector<std::uint64_t> newest_read;
  for (std::uint64_t number = 1; number <= 60; ++number) {
    board.publish(sensor.lend(number));
    if (number % 5 != 0) continue;
    while (const auto pinned = every.tryNext()) read.push_back(pinned->picture.number);
    if (number % 30 == 0) newest_read.push_back(newest.tryNewest()->picture.number);
  }
  ASSERT_EQ(read.size(), 60u);
  for (std::uint64_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i], i + 1);
  EXPECT_THAT(newest_read, testing::ElementsAre(30u, 60u));
  EXPECT_FALSE(newest.tryNewest()) << "no picture came since";
  EXPECT_EQ(every.status().lost, 0u);
  EXPECT_EQ(newest.status().lost, 0u) << "passed over, as it wants it";
}

TEST(DepthBoard, CountsWhatAReaderOfEveryPictureWasTooSlowFor) {
  DepthBoard board;
  DepthReader& reader = readerOf(board, "slow", 1);
  Lender sensor;
  for (std::uint64_t number = 1; number <= 20; ++number) board.publish(sensor.lend(number));
  const auto pinned = reader.tryNext();
  ASSERT_TRUE(pinned);
  EXPECT_EQ(pinned->picture.number, 20 - DepthBoard::kKept + 1);
  EXPECT_EQ(reader.status().lost, 20 - DepthBoard::kKept);
}

TEST(DepthBoard, AReaderThatNeverLetsGoCostsOnlyItself) {
  DepthBoard board;
  DepthReader& hoarder = readerOf(board, "hoarder", 3);
  DepthReader& other = readerOf(board, "other", 1);
  Lender sensor;
  std::vector<PinnedDepth> hoard;
  for (std::uint64_t number = 1; number <= 1000; ++number) {
    board.publish(sensor.lend(number));
    if (auto pinned = hoarder.tryNext()) hoard.push_back(std::move(*pinned));
    const auto pinned = other.tryNext();
    ASSERT_TRUE(pinned) << number;
    EXPECT_EQ(pinned->picture.number, number);
  }
  ASSERT_EQ(hoard.size(), 3u);
  for (std::size_t i = 0; i < hoard.size(); ++i) EXPECT_TRUE(holds(hoard[i], i + 1));
  EXPECT_EQ(hoarder.status().refused, 997u);
  EXPECT_EQ(hoarder.status().pinned, 3u);
  EXPECT_EQ(other.status().lost, 0u);
  hoard.clear();
  EXPECT_EQ(hoarder.status().pinned, 0u);
  EXPECT_TRUE(hoarder.tryNewest());
}

TEST(DepthBoard, TakesASensorOfAnotherSizeWhilePinsAreHeld) {
  DepthBoard board;
  DepthReader& reader = readerOf(board, "a", 2);
  Lender small(4, 2);
  Lender large(16, 8);
  board.publish(small.lend(1));
  const auto first = reader.tryNext();
  ASSERT_TRUE(first);
  for (std::uint64_t number = 2; number <= 30; ++number) board.publish(large.lend(number, false));
  EXPECT_EQ(first->depth_mm.size(), 8u);
  EXPECT_TRUE(holds(*first, 1));
  const auto newest = reader.tryNewest();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->depth_mm.size(), 128u);
  EXPECT_TRUE(newest->colour_rgb.empty());
}

TEST(DepthBoard, WakesEachReaderThatWaits) {
  DepthBoard board;
  DepthReader& one = readerOf(board, "one", 1);
  DepthReader& two = readerOf(board, "two", 1);
  EXPECT_FALSE(one.waitUntil(rt::now()));
  Lender sensor;
  board.publish(sensor.lend(1));
  EXPECT_TRUE(one.waitUntil(rt::now() + 10s));
  EXPECT_TRUE(two.waitUntil(rt::now() + 10s));
}

TEST(DepthBoard, RefusesReadersBeyondItsMemory) {
  DepthBoard board;
  EXPECT_THAT(board.openReader("greedy", DepthBoard::kMostPins + 1).error(),
              HasSubstr("greedy asks the depth board for 17 pins, 16 are left"));
  for (std::size_t i = 0; i < DepthBoard::kMostReaders; ++i)
    (void)readerOf(board, "reader" + std::to_string(i), 2);
  EXPECT_THAT(board.openReader("late", 0).error(), HasSubstr("no room for reader late"));
}

/// A reader's thread for as long as the sensor runs: takes pictures in its own way and keeps the
/// last ones pinned. True: every pinned picture stayed what it was, and numbers only grew.
bool readAll(DepthReader& reader, bool every, std::size_t keep, const std::atomic<bool>& end) {
  bool good = true;
  std::uint64_t last = 0;
  std::deque<PinnedDepth> kept;
  while (!end.load()) {
    if (kept.size() == keep) {
      good = good && holds(kept.front(), kept.front().picture.sensor_number);
      kept.pop_front();
    }
    auto pinned = every ? reader.tryNext() : reader.tryNewest();
    if (!pinned) {
      (void)reader.waitUntil(rt::now() + 1ms);
      continue;
    }
    good = good && pinned->picture.number > last && holds(*pinned, pinned->picture.sensor_number);
    last = pinned->picture.number;
    kept.push_back(std::move(*pinned));
  }
  return good && last > 0;
}

TEST(DepthBoard, PinnedPicturesNeverChangeUnderManyReaders) {
  DepthBoard board;
  std::atomic<bool> end{false};
  std::atomic<int> good{0};
  constexpr int kReaders = 4;
  {
    std::vector<std::jthread> readers;
    for (int r = 0; r < kReaders; ++r) {
      DepthReader& reader = readerOf(board, "reader" + std::to_string(r), 3);
      readers.emplace_back([&reader, &end, &good, every = r % 2 == 0] {
        if (readAll(reader, every, 3, end)) ++good;
      });
    }
    Lender sensor;
    for (std::uint64_t number = 1; number <= 20'000; ++number) {
      board.publish(sensor.lend(number));
      if (number % 16 == 0) std::this_thread::yield();
    }
    const auto allTook = [&board] {
      return std::ranges::all_of(board.readers(),
                                 [](const auto& reader) { return reader.taken > 0; });
    };
    while (!allTook()) std::this_thread::yield();
    end = true;
  }
  EXPECT_EQ(good, kReaders);
  for (const auto& reader : board.readers()) {
    EXPECT_EQ(reader.pinned, 0u) << reader.name;
    EXPECT_EQ(reader.refused, 0u) << reader.name << " let go before it asked for more";
  }
}

}  // namespace

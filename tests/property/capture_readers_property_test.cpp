// What readers may do to the frame history: nothing that costs the camera or another reader.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/capture/frame_cursor.h"
#include "appliance/capture/frame_history.h"

namespace {

using namespace appliance;

constexpr std::size_t kFrameBytes = 64;

/// One camera of the history: fills the slots that it was given, in turn.
class Filler {
 public:
  explicit Filler(CameraFrames& frames)
      : frames_(frames), queue_(frames.fillingSlots().begin(), frames.fillingSlots().end()) {}

  /// False if no slot was free for the frame.
  bool deliver(std::uint64_t trigger) {
    const std::uint32_t slot = queue_.front();
    queue_.pop_front();
    std::memset(frames_.slots()[slot].data(), static_cast<int>(trigger & 0xFF), kFrameBytes);
    queue_.push_back(frames_.store(slot, {.trigger = trigger}));
    return queue_.back() != slot;
  }

 private:
  CameraFrames& frames_;
  std::deque<std::uint32_t> queue_;
};

bool isUnchanged(const PinnedFrame& frame) {
  return std::ranges::all_of(std::span(frame.pixels, kFrameBytes), [&](std::byte byte) {
    return byte == static_cast<std::byte>(frame.frame.trigger & 0xFF);
  });
}

/// A reader, and what it holds of each camera.
struct Reader {
  FrameReader* access;
  std::vector<std::vector<PinnedFrame>> held;
  std::uint64_t refused = 0;
};

struct Box {
  explicit Box(std::uint32_t cameras, std::uint32_t sets, std::uint32_t in_flight,
               const std::vector<std::uint32_t>& budgets) {
    std::uint32_t reserve = 0;
    for (const std::uint32_t pins : budgets) reserve += pins;
    history = std::move(
        *FrameHistory::create({.frame_bytes = std::vector<std::size_t>(cameras, kFrameBytes),
                               .sets = sets,
                               .in_flight = in_flight,
                               .reserve = reserve}));
    for (std::uint32_t i = 0; i < cameras; ++i) fillers.emplace_back(history->camera(i));
    for (const std::uint32_t pins : budgets) {
      readers.push_back({.access = *history->openReader("reader", pins), .held = {}});
      readers.back().held.resize(cameras);
    }
  }

  std::unique_ptr<FrameHistory> history;
  std::vector<Filler> fillers;
  std::vector<Reader> readers;
};

template <class T>
T anyIn(T from, T until) {
  return *rc::gen::inRange<T>(from, until);
}

RC_GTEST_PROP(FrameReaders, NeverExceedTheirBudgetsNorCostTheCameraAFrame, ()) {
  const auto cameras = anyIn<std::uint32_t>(1, 3);
  const auto sets = anyIn<std::uint32_t>(2, 9);
  const auto budgets = *rc::gen::container<std::vector<std::uint32_t>>(
      anyIn<std::size_t>(1, 4), rc::gen::inRange<std::uint32_t>(1, 4));
  Box box(cameras, sets, anyIn<std::uint32_t>(1, 5), budgets);

  std::uint64_t trigger = 0;
  const auto steps = anyIn(0, 300);
  for (int step = 0; step < steps; ++step) {
    const auto camera = anyIn<std::uint32_t>(0, cameras);
    Reader& reader = box.readers[anyIn<std::size_t>(0, box.readers.size())];
    std::vector<PinnedFrame>& held = reader.held[camera];
    const bool full = held.size() == reader.access->pinsPerCamera();
    switch (anyIn(0, 5)) {
      case 0:
      case 1:  // a trigger: some cameras miss it
        ++trigger;
        for (std::uint32_t i = 0; i < cameras; ++i) {
          if (anyIn(0, 6) != 0) RC_ASSERT(box.fillers[i].deliver(trigger));
        }
        break;
      case 2: {  // any trigger, stored or not
        const std::uint64_t wanted =
            trigger - std::min<std::uint64_t>(trigger, anyIn(0U, sets + 2));
        const bool stored = box.history->camera(camera).holds(wanted);
        auto frame = reader.access->tryPin(camera, wanted);
        RC_ASSERT(frame.has_value() == (stored && !full));
        if (stored && full) ++reader.refused;
        if (frame) held.push_back(std::move(*frame));
        break;
      }
      case 3:  // once more what it holds, which may be overtaken
        if (!held.empty()) {
          auto again = held[anyIn<std::size_t>(0, held.size())].tryAgain();
          RC_ASSERT(again.has_value() == !full);
          if (full) ++reader.refused;
          if (again) held.push_back(std::move(*again));
        }
        break;
      default:
        if (!held.empty()) {
          std::swap(held.back(), held[anyIn<std::size_t>(0, held.size())]);
          held.pop_back();
        }
    }
    for (const Reader& one : box.readers) {
      for (std::uint32_t i = 0; i < cameras; ++i) {
        RC_ASSERT(one.access->pinned(i) == one.held[i].size());
        for (const PinnedFrame& frame : one.held[i]) RC_ASSERT(isUnchanged(frame));
      }
      RC_ASSERT(one.access->report().refused == one.refused);
    }
  }
}

TEST(FrameReaders, OneThatHoldsItsPinsForeverCostsOnlyItself) {
  Box box(2, 10, 3, {2, 1});
  Reader& stuck = box.readers[0];
  Reader& other = box.readers[1];
  for (std::uint64_t trigger = 1; trigger <= 5; ++trigger) {
    for (Filler& camera : box.fillers) ASSERT_TRUE(camera.deliver(trigger));
  }
  for (std::uint32_t camera = 0; camera < 2; ++camera) {
    stuck.held[camera].push_back(*stuck.access->tryPin(camera, 3));
    stuck.held[camera].push_back(*stuck.access->tryPin(camera, 4));
  }
  for (std::uint64_t trigger = 6; trigger <= 1000; ++trigger) {
    for (std::uint32_t camera = 0; camera < 2; ++camera) {
      ASSERT_TRUE(box.fillers[camera].deliver(trigger)) << trigger;
      ASSERT_FALSE(stuck.access->tryPin(camera, trigger)) << "beyond its budget";
      const auto frame = other.access->tryPin(camera, trigger > 9 ? trigger - 9 : 1);
      ASSERT_TRUE(frame && isUnchanged(*frame)) << "all sets are there for another reader";
    }
  }
  for (const auto& frames : stuck.held) {
    for (const PinnedFrame& frame : frames) EXPECT_TRUE(isUnchanged(frame));
  }
  EXPECT_EQ(stuck.access->report().refused, 2U * 995);
  EXPECT_EQ(other.access->report().refused, 0U);
  const auto remarks = box.history->remarks();
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(textOf(remarks[0]), testing::HasSubstr("2 frames per camera"));
}

TEST(FrameReaders, AreRefusedBeyondTheReserveOfTheHistory) {
  Box box(1, 4, 2, {3});
  const auto more = box.history->openReader("clips", 1);
  ASSERT_FALSE(more);
  EXPECT_THAT(more.error(),
              testing::HasSubstr("reader clips asks for 1 pins per camera, 0 are left"));
}

TEST(CameraFrames, DropsTheNewFrameAndKeepsTheOldOnesWhenReadersHoldEverySlot) {
  // Two slots less than the pins: a layout that FrameHistory would not give.
  std::vector<std::byte> memory(std::size_t{4} + 1 + 1);
  std::vector<std::span<std::byte>> slots;
  for (std::byte& slot : memory) slots.emplace_back(&slot, 1);
  CameraFrames frames(slots, {}, 4, 1);
  rt::PinBudget budget(2);
  std::uint32_t slot = frames.fillingSlots()[0];
  for (std::uint64_t trigger = 1; trigger <= 4; ++trigger) {
    slot = frames.store(slot, {.trigger = trigger});
  }
  std::vector<PinnedFrame> pins;
  pins.push_back(*frames.tryPin(1, budget));
  const std::uint32_t filled = frames.store(slot, {.trigger = 5});  // parks the frame of trigger 1
  ASSERT_NE(filled, slot);
  EXPECT_EQ(frames.store(filled, {.trigger = 6}), filled);
  EXPECT_EQ(frames.newest(), 5U);
  EXPECT_FALSE(frames.holds(6));
  for (std::uint64_t trigger = 2; trigger <= 5; ++trigger) EXPECT_TRUE(frames.holds(trigger));
  pins.clear();
  EXPECT_NE(frames.store(filled, {.trigger = 7}), filled) << "the next one is stored again";
  EXPECT_EQ(frames.newest(), 7U);
}

TEST(HistoryLayout, MoreSlotsThanCanBeNumberedAreRefusedInOneLine) {
  const auto history = FrameHistory::create({.frame_bytes = {1}, .sets = 65'530, .in_flight = 8});
  ASSERT_FALSE(history);
  EXPECT_THAT(history.error(), testing::HasSubstr("lower history.sets"));
  EXPECT_EQ(history.error().find('\n'), std::string::npos);
}

RC_GTEST_PROP(FrameCursorProperty, GivesEachFrameOnceInOrderOrCountsIt, ()) {
  const auto sets = anyIn<std::uint32_t>(2, 9);
  Box box(1, sets, 2, {2});
  FrameCursor cursor(*box.readers[0].access, 0);
  std::map<std::uint64_t, std::uint64_t> number_of;  // of each trigger's frame
  std::uint64_t trigger = 0;
  std::uint64_t newest = 0;  // stored
  std::uint64_t last = 0;
  std::uint64_t given = 0;
  std::uint64_t first_number = 0;
  const auto steps = anyIn(0, 200);
  for (int step = 0; step < steps; ++step) {
    for (int more = anyIn(0, 4); more > 0; --more) {
      ++trigger;
      if (anyIn(0, 4) == 0) continue;  // the camera misses this one
      RC_ASSERT(box.fillers[0].deliver(trigger));
      number_of[trigger] = number_of.size() + 1;
      newest = trigger;
    }
    if (anyIn(0, 3) == 0) continue;  // the reader is busy
    while (const auto frame = cursor.tryNext()) {
      RC_ASSERT(frame->frame.trigger > last);
      RC_ASSERT(isUnchanged(*frame));
      RC_ASSERT(frame->frame.number == number_of[frame->frame.trigger]);
      last = frame->frame.trigger;
      if (++given == 1) first_number = frame->frame.number;
      RC_ASSERT(given + cursor.tooSlowFor() == frame->frame.number - first_number + 1);
    }
    // Nothing that is stored was left out.
    RC_ASSERT(last == newest);
  }
}

TEST(FrameCursor, WaitsWhenItsReaderHoldsAllItsPins) {
  Box box(1, 8, 2, {2});
  FrameCursor cursor(*box.readers[0].access, 0);
  ASSERT_TRUE(box.fillers[0].deliver(1));
  std::vector<PinnedFrame> held;
  for (std::uint64_t trigger = 2; trigger <= 4; ++trigger) {
    if (auto frame = cursor.tryNext()) held.push_back(std::move(*frame));
    ASSERT_TRUE(box.fillers[0].deliver(trigger));
  }
  ASSERT_EQ(held.size(), 2U);
  EXPECT_FALSE(cursor.tryNext());
  held.clear();
  const auto next = cursor.tryNext();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->frame.trigger, 3U);
  EXPECT_EQ(cursor.tooSlowFor(), 0U);
}

}  // namespace

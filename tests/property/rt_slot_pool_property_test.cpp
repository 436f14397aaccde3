#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <map>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "rt/slot_pool.h"

namespace {

/// Random histories of one pool, step by step against a plain model of who has which slot.
RC_GTEST_PROP(SlotPoolProperty, LosesAndDoublesNoSlotInAnyOrderOfEvents, ()) {
  const auto slots = *rc::gen::inRange<std::uint32_t>(1, 9);
  rt::SlotPool pool(slots);
  std::set<std::uint32_t> filling;
  std::map<std::uint32_t, std::uint64_t> published;
  std::vector<std::pair<std::uint32_t, rt::SlotPin>> pins;
  std::uint64_t next_tag = 0;

  const auto anyOf = [](const auto& container) {
    const auto at = *rc::gen::inRange<std::size_t>(0, container.size());
    return std::next(container.begin(), static_cast<std::ptrdiff_t>(at));
  };
  const auto isPinned = [&](std::uint32_t slot) {
    return std::ranges::any_of(pins, [&](const auto& pin) { return pin.first == slot; });
  };

  const auto steps = *rc::gen::inRange(0, 200);
  for (int step = 0; step < steps; ++step) {
    switch (*rc::gen::inRange(0, 5)) {
      case 0: {
        std::size_t in_use = 0;
        for (std::uint32_t slot = 0; slot < slots; ++slot) {
          if (filling.contains(slot) || published.contains(slot) || isPinned(slot)) ++in_use;
        }
        const auto slot = pool.tryAcquire();
        RC_ASSERT(slot.has_value() == (in_use < slots));
        if (slot) {
          RC_ASSERT(!isPinned(*slot) && !published.contains(*slot));
          RC_ASSERT(filling.insert(*slot).second);
        }
        break;
      }
      case 1:
        if (!filling.empty()) {
          const auto slot = *anyOf(filling);
          pool.publish(slot, next_tag);
          published[slot] = next_tag++;
          filling.erase(slot);
        }
        break;
      case 2:
        if (!published.empty()) {
          const auto slot = anyOf(published)->first;
          pool.retire(slot);
          published.erase(slot);
        }
        break;
      case 3: {
        const auto slot = *rc::gen::inRange<std::uint32_t>(0, slots);
        const auto tag = *rc::gen::inRange<std::uint64_t>(0, next_tag + 1);
        auto pin = pool.tryPin(slot, tag);
        const auto it = published.find(slot);
        RC_ASSERT(pin.has_value() == (it != published.end() && it->second == tag));
        if (pin) pins.emplace_back(slot, std::move(*pin));
        break;
      }
      default:
        if (!pins.empty()) pins.erase(anyOf(pins));
    }
  }
  pins.clear();
  for (const auto& [slot, tag] : published) pool.retire(slot);
  auto all = filling;  // handed out once each, and never before they were retired
  while (const auto slot = pool.tryAcquire()) RC_ASSERT(all.insert(*slot).second);
  RC_ASSERT(all.size() == slots);
}

constexpr std::uint64_t kDepth = 8;  // frames the history shows
constexpr std::size_t kReaders = 3;
constexpr std::size_t kPinsPerReader = 2;
constexpr auto kSlots = static_cast<std::uint32_t>(kDepth + 1 + kReaders * kPinsPerReader);
constexpr std::uint64_t kLooksPerReader = 3000;

/// A frame history in small: payloads are plain memory, so that the thread
/// sanitizer itself checks that writer and readers never meet in a slot.
struct History {
  using Payload = std::array<std::uint64_t, 32>;

  rt::SlotPool pool{kSlots};
  std::array<Payload, kSlots> payloads{};
  std::array<std::atomic<std::uint64_t>, kDepth> index{};  // tag << 8 | slot, relaxed: a mere hint
  std::atomic<std::size_t> readers_done{0};
  std::uint32_t shown_at_end = 0;  // the readers may be done before the depth was reached

  static std::uint64_t contentOf(std::uint64_t tag) { return tag * 0x9E3779B97F4A7C15U; }

  /// Writes until every reader has looked often enough.
  /// @return how often no slot was free
  int write() {
    int refused = 0;
    std::deque<std::uint32_t> shown;
    for (std::uint64_t tag = 1; readers_done.load() < kReaders; ++tag) {
      const auto slot = pool.tryAcquire();
      if (!slot) {
        ++refused;
        continue;
      }
      payloads[*slot].fill(contentOf(tag));
      if (shown.size() == kDepth) {
        pool.retire(shown.front());
        shown.pop_front();
      }
      pool.publish(*slot, tag);
      shown.push_back(*slot);
      index[tag % kDepth].store((tag << 8) | *slot, std::memory_order_relaxed);
      if (tag % 4 == 0) std::this_thread::yield();
    }
    shown_at_end = static_cast<std::uint32_t>(shown.size());
    return refused;
  }

  [[nodiscard]] bool holds(std::uint32_t slot, std::uint64_t tag) const {
    return std::ranges::all_of(payloads[slot], [&](auto word) { return word == contentOf(tag); });
  }

  /// @return how often pinned content was not what its tag says
  int read(std::uint32_t seed) {
    std::mt19937 random(seed);
    int changed = 0;
    std::deque<std::pair<std::uint64_t, rt::SlotPin>> held;
    for (std::uint64_t looks = 0; looks < kLooksPerReader;) {
      // anything from the newest frame to the one just being overwritten
      const auto entry = index[random() % kDepth].load(std::memory_order_relaxed);
      const std::uint64_t tag = entry >> 8;
      const auto slot = static_cast<std::uint32_t>(entry & 0xFF);
      if (held.size() == kPinsPerReader) {
        if (!holds(held.front().second.slot(), held.front().first)) ++changed;
        held.pop_front();
      }
      if (auto pin = pool.tryPin(slot, tag); tag != 0 && pin) {
        ++looks;
        if (!holds(slot, tag)) ++changed;
        held.emplace_back(tag, std::move(*pin));
      }
      if (random() % 8 == 0) std::this_thread::yield();
    }
    ++readers_done;
    return changed;
  }
};

TEST(SlotPoolConcurrency, KeepsPinnedContentUnchangedWhileTheWriterNeverWaits) {
  for (std::uint32_t round = 0; round < 5; ++round) {
    History history;
    std::array<int, kReaders> changed{};
    int refused = 0;
    {
      std::vector<std::jthread> readers;
      readers.reserve(kReaders);
      for (std::uint32_t r = 0; r < kReaders; ++r) {
        readers.emplace_back([&, r] { changed[r] = history.read(round * 100 + r); });
      }
      refused = history.write();
    }
    EXPECT_EQ(refused, 0) << "the reserve covers all pins together";
    EXPECT_THAT(changed, testing::Each(0));

    (void)history.pool.tryAcquire();  // collects what the readers held to the end
    EXPECT_EQ(history.pool.parkedSlots(), 0u);
    EXPECT_EQ(history.pool.freeSlots(), kSlots - history.shown_at_end - 1);
  }
}

}  // namespace

#include <atomic>
#include <cstring>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/capture/frame_history.h"

namespace {

using namespace appliance;

constexpr std::uint32_t kSets = 12;
constexpr std::uint32_t kInFlight = 3;
constexpr std::uint32_t kReserve = 4;
constexpr std::size_t kFrameBytes = 4096;

std::unique_ptr<FrameHistory> makeHistory() {
  auto history = FrameHistory::create(
      {.frame_bytes = {kFrameBytes}, .sets = kSets, .in_flight = kInFlight, .reserve = kReserve});
  EXPECT_TRUE(history) << history.error();
  return std::move(*history);
}

/// A reader that may use the whole reserve.
FrameReader& openReader(FrameHistory& history) {
  const auto reader = history.openReader("test", kReserve);
  EXPECT_TRUE(reader) << reader.error();
  return **reader;
}

/// Delivers triggers as a camera does: fills the slot it was given, stores it, takes the next.
class Filler {
 public:
  explicit Filler(CameraFrames& frames)
      : frames_(frames), queue_(frames.fillingSlots().begin(), frames.fillingSlots().end()) {}

  void deliver(std::uint64_t trigger) {
    const std::uint32_t slot = queue_.front();
    queue_.erase(queue_.begin());
    std::memset(frames_.slots()[slot].data(), static_cast<int>(trigger & 0xFF), kFrameBytes);
    queue_.push_back(frames_.store(slot, {.trigger = trigger, .frame_id = trigger}));
  }

 private:
  CameraFrames& frames_;
  std::vector<std::uint32_t> queue_;
};

bool holdsOnly(const PinnedFrame& frame, std::uint64_t trigger) {
  for (std::size_t i = 0; i < kFrameBytes; ++i) {
    if (frame.pixels[i] != static_cast<std::byte>(trigger & 0xFF)) return false;
  }
  return frame.frame.trigger == trigger;
}

TEST(FrameHistory, KeepsTheLastSetsAndForgetsOlderOnes) {
  const auto history = makeHistory();
  CameraFrames& frames = history->camera(0);
  FrameReader& reader = openReader(*history);
  Filler camera(frames);
  EXPECT_EQ(frames.newest(), 0U);
  EXPECT_EQ(frames.oldest(), 0U);
  for (std::uint64_t trigger = 1; trigger <= 40; ++trigger) camera.deliver(trigger);

  EXPECT_EQ(frames.newest(), 40U);
  EXPECT_EQ(frames.oldest(), 40 - kSets + 1);
  for (std::uint64_t trigger = 1; trigger <= 41; ++trigger) {
    const auto pinned = reader.tryPin(0, trigger);
    EXPECT_EQ(pinned.has_value(), trigger > 40 - kSets && trigger <= 40) << trigger;
    if (pinned) {
      EXPECT_TRUE(holdsOnly(*pinned, trigger)) << trigger;
    }
  }
}

TEST(FrameHistory, HasNoFrameOfATriggerThatTheCameraMissed) {
  const auto history = makeHistory();
  CameraFrames& frames = history->camera(0);
  FrameReader& reader = openReader(*history);
  Filler camera(frames);
  for (const std::uint64_t trigger : {1U, 2U, 4U, 5U}) camera.deliver(trigger);
  EXPECT_TRUE(frames.holds(2));
  EXPECT_FALSE(frames.holds(3));
  EXPECT_FALSE(reader.tryPin(0, 3));
  EXPECT_TRUE(reader.tryPin(0, 4));
  EXPECT_FALSE(reader.tryPin(0, 0));
}

TEST(FrameHistory, KeepsAPinnedFrameWhileTheCameraGoesRoundManyTimes) {
  const auto history = makeHistory();
  CameraFrames& frames = history->camera(0);
  FrameReader& reader = openReader(*history);
  Filler camera(frames);
  for (std::uint64_t trigger = 1; trigger <= 5; ++trigger) camera.deliver(trigger);
  std::vector<PinnedFrame> pins;
  for (std::uint64_t trigger = 2; trigger < 2 + kReserve; ++trigger) {
    pins.push_back(*reader.tryPin(0, trigger));
  }
  for (std::uint64_t trigger = 6; trigger <= 200; ++trigger) camera.deliver(trigger);
  for (std::size_t i = 0; i < pins.size(); ++i) EXPECT_TRUE(holdsOnly(pins[i], 2 + i));
}

TEST(FrameHistory, NeverChangesAFrameUnderARandomReader) {
  const auto history = makeHistory();
  CameraFrames& frames = history->camera(0);
  FrameReader& reader = openReader(*history);
  constexpr std::uint64_t kTriggers = 4000;
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> torn{0};
  std::atomic<std::uint64_t> pinned{0};

  const auto read = [&](unsigned seed) {
    std::mt19937_64 random(seed);
    while (!done.load(std::memory_order_acquire)) {
      const std::uint64_t newest = frames.newest();
      const std::uint64_t trigger =
          newest - std::min<std::uint64_t>(newest, random() % (kSets + 2));
      const auto frame = reader.tryPin(0, trigger);
      if (!frame) continue;
      pinned.fetch_add(1, std::memory_order_relaxed);
      for (int look = 0; look < 3; ++look) {
        if (!holdsOnly(*frame, trigger)) torn.fetch_add(1, std::memory_order_relaxed);
      }
    }
  };
  {
    std::vector<std::jthread> readers;
    for (unsigned seed = 1; seed <= kReserve; ++seed) readers.emplace_back(read, seed);
    Filler camera(frames);
    for (std::uint64_t trigger = 1; trigger <= kTriggers; ++trigger) {
      camera.deliver(trigger);
      if (trigger % 16 == 0) std::this_thread::yield();
    }
    // On a busy machine the readers may not have run yet.
    while (pinned.load(std::memory_order_relaxed) == 0) std::this_thread::yield();
    done.store(true, std::memory_order_release);
  }
  EXPECT_EQ(torn.load(), 0U);
}

TEST(FitHistory, KeepsAllSetsIfMemoryAllowsIt) {
  const HistoryLayout layout{.frame_bytes = {kFrameBytes, kFrameBytes}, .sets = 300};
  const auto fitted = fitHistory(layout, layout.bytes(), 8);
  ASSERT_TRUE(fitted);
  EXPECT_EQ(fitted->sets, 300U);
}

TEST(FitHistory, GivesUpSetsButNotSlotsInFlight) {
  const HistoryLayout layout{.frame_bytes = {kFrameBytes, kFrameBytes}, .sets = 300};
  const auto fitted = fitHistory(layout, layout.bytes() / 2, 8);
  ASSERT_TRUE(fitted);
  EXPECT_LT(fitted->sets, 300U);
  EXPECT_GT(fitted->sets, 100U);
  EXPECT_LE(fitted->bytes(), layout.bytes() / 2);
  EXPECT_EQ(fitted->in_flight, layout.in_flight);
}

TEST(FitHistory, RefusesWhenNotEvenTheFewestSetsFit) {
  const HistoryLayout layout{.frame_bytes = {kFrameBytes}, .sets = 300};
  EXPECT_FALSE(fitHistory(layout, kFrameBytes * 10, 8));
}

}  // namespace

// Two hours of random presses, as fast as the machine computes: no dead end, and never a moment
// that was not asked for.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/director/director.h"

namespace {

using appliance::Command;
using appliance::Director;
using appliance::Mode;
using appliance::Rate;
using appliance::Shot;
using appliance::StoredRange;
using appliance::StoredViews;

constexpr std::uint32_t kCameras = 6;
constexpr std::uint64_t kSets = 200;
constexpr rt::Nanoseconds kPeriod = std::chrono::milliseconds(25);
constexpr std::uint32_t kVblanks = 2;  // of each trigger

/// Cameras that lose frames and come and go, a memory of a few seconds, and one held moment.
class Box : public StoredViews {
 public:
  void capture(std::mt19937& random) {
    ++newest_;
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      if (random() % 900 == 0) living_[camera] = !living_[camera];
      if (!living_[camera] || random() % 50 == 0) continue;
      frames_[camera][newest_ % kSets] = newest_;
      newest_of_[camera] = newest_;
    }
  }
  void hold(std::uint64_t trigger) {
    std::array<bool, kCameras> holders{};
    bool any = false;
    for (std::uint32_t camera = 0; camera < kCameras; ++camera)
      any |= holders[camera] = stores(camera, trigger);
    if (trigger == held_ || (trigger != 0 && !any)) return;
    held_ = trigger;
    holders_ = holders;
  }

  [[nodiscard]] std::uint32_t cameras() const noexcept override { return kCameras; }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const noexcept override {
    const std::uint64_t newest = newest_of_[camera];
    if (newest == 0) return {};
    return {newest_ > kSets ? std::min(newest_ - kSets + 1, newest) : 1, newest};
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const noexcept override {
    return stores(camera, trigger) || (trigger != 0 && trigger == held_ && holders_[camera]);
  }
  [[nodiscard]] bool living(std::uint32_t camera) const noexcept override {
    return living_[camera] && newest_of_[camera] != 0;
  }
  [[nodiscard]] std::uint64_t heldTrigger() const noexcept override { return held_; }
  /// Of all living cameras, from which delays count; of all when none lives.
  [[nodiscard]] std::uint64_t newest() const {
    std::uint64_t of_living = 0;
    std::uint64_t of_all = 0;
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      of_all = std::max(of_all, newest_of_[camera]);
      if (living_[camera]) of_living = std::max(of_living, newest_of_[camera]);
    }
    return of_living == 0 ? of_all : of_living;
  }

 private:
  [[nodiscard]] bool stores(std::uint32_t camera, std::uint64_t trigger) const {
    return trigger != 0 && frames_[camera][trigger % kSets] == trigger;
  }

  std::uint64_t newest_ = 0;
  std::array<std::array<std::uint64_t, kSets>, kCameras> frames_{};
  std::array<std::uint64_t, kCameras> newest_of_{};
  std::array<bool, kCameras> living_{true, true, true, true, true, true};
  std::uint64_t held_ = 0;
  std::array<bool, kCameras> holders_{};
};

Command anyPress(std::mt19937& random) {
  constexpr auto kKinds = static_cast<unsigned>(Command::Kind::kReplay) + 1;
  return {.kind = static_cast<Command::Kind>(random() % kKinds),
          .camera = static_cast<std::uint32_t>(random() % (kCameras + 1)),
          .delay = std::chrono::milliseconds(random() % 6000),
          .rate = static_cast<Rate>(random() % 5),
          .composition = {.layout = static_cast<appliance::Layout>(random() % 4)}};
}

/// What a moment may be, given the picture before and what was pressed since.
void expectAskedFor(const Shot& before, const Shot& now, const std::vector<Command>& pressed,
                    const Box& box) {
  const bool kept = now.trigger == before.trigger;
  if (kept || now.trigger == 0) return;
  const std::int64_t way = static_cast<std::int64_t>(now.trigger - before.trigger);
  switch (now.mode) {
    case Mode::kFrozen:
    case Mode::kSweep:
      if (pressed.empty()) {
        // A playback that the memory's end overtook stops near where it was.
        ASSERT_TRUE(before.mode == Mode::kSlow || before.mode == Mode::kDelayed ||
                    now.at_history_end);
        ASSERT_TRUE(now.at_history_end);
      }
      ASSERT_TRUE(box.holds(now.camera_shown, now.trigger));
      return;
    case Mode::kLive:
      ASSERT_EQ(now.trigger, box.range(now.camera_shown).newest);
      return;
    case Mode::kDelayed: {
      const auto age = static_cast<std::int64_t>(box.newest() - now.trigger);
      ASSERT_LE(std::abs(age - now.delay / kPeriod), 40) << "a hole's width and a little";
      return;
    }
    case Mode::kSlow:
      if (before.mode == Mode::kSlow && pressed.empty()) {
        ASSERT_GE(way, -40);
        ASSERT_LE(way, 40);
      }
      return;
  }
}

TEST(TwoHoursOfPresses, LeadToNoDeadEndAndToNoMomentThatWasNotAskedFor) {
  std::mt19937 random(20261130);
  Box box;
  Director director{
      {.first_view = 2, .delay_ladder = {std::chrono::milliseconds(500), std::chrono::seconds(2)}}};
  rt::Timestamp now = rt::fromNs(1'000'000'000);
  Shot shot;
  const auto vblank = [&](const std::vector<Command>& pressed) {
    now += kPeriod / kVblanks;
    const Shot before = shot;
    shot = director.tick({.at = now, .refresh = kPeriod / kVblanks}, kPeriod, box, pressed);
    box.hold(shot.hold);
    ASSERT_LT(shot.camera_shown, kCameras);
    ASSERT_EQ(director.outcomes().size(), pressed.size());
    expectAskedFor(before, shot, pressed, box);
    if (shot.second.trigger != 0) {
      ASSERT_TRUE(box.holds(shot.second.camera, shot.second.trigger));
      ASSERT_LE(shot.second.trigger, shot.trigger);
    }
    if (shot.mode == Mode::kFrozen && before.mode == Mode::kFrozen && pressed.empty()) {
      ASSERT_EQ(shot.trigger, before.trigger);
      ASSERT_EQ(shot.camera_shown, before.camera_shown);
    }
  };
  std::array<std::uint64_t, appliance::kModes.size()> home_from{};
  constexpr int kTriggers = 2 * 3600 * 40;
  for (int i = 0; i < kTriggers; ++i) {
    box.capture(random);
    std::vector<Command> pressed;
    if (random() % 20 == 0) pressed.push_back(anyPress(random));
    if (random() % 200 == 0) pressed.push_back(anyPress(random));
    vblank(pressed);
    vblank({});
    if (testing::Test::HasFatalFailure()) FAIL() << "trigger " << i;
    if (random() % 100 != 0) continue;
    ++home_from[static_cast<std::size_t>(shot.mode)];
    vblank({{.kind = Command::Kind::kHome}});
    ASSERT_EQ(shot.mode, Mode::kLive);
    ASSERT_EQ(shot.trigger, box.range(shot.camera_shown).newest);
    ASSERT_EQ(shot.camera_wanted, (kCameras - 1) / 2);
  }
  for (const appliance::ModeRow& row : appliance::kModes)
    EXPECT_GT(home_from[static_cast<std::size_t>(row.mode)], 20U) << row.name;
}

}  // namespace

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "appliance/director/director.h"
#include "tests/property/any_value.h"

namespace {

using appliance::Command;
using appliance::Director;
using appliance::Mode;
using appliance::Shot;
using appliance::StoredRange;
using appliance::StoredViews;
using property_test::anyBits;
using property_test::anyIn;

constexpr rt::Nanoseconds kPeriod = std::chrono::milliseconds(25);
constexpr std::uint64_t kSets = 60;

/// A history that cameras feed one trigger at a time, with losses; they die and come back. It keeps
/// the frames of one moment that the director wants held.
class LossyHistory : public StoredViews {
 public:
  explicit LossyHistory(std::uint32_t cameras) : frames_(cameras), living_(cameras, 1) {}

  void store(std::uint32_t camera, std::uint64_t trigger) {
    frames_[camera].insert(trigger);
    frames_[camera].erase(frames_[camera].begin(),
                          frames_[camera].lower_bound(trigger > kSets ? trigger - kSets + 1 : 1));
  }
  /// As the render thread does after each decision; a frame that is gone cannot be held.
  void hold(std::uint64_t trigger) {
    if (trigger == held_) return;
    std::set<std::uint32_t> holders;
    for (std::uint32_t camera = 0; camera < cameras(); ++camera)
      if (frames_[camera].contains(trigger)) holders.insert(camera);
    if (trigger != 0 && holders.empty()) return;
    held_ = trigger;
    holders_ = std::move(holders);
  }
  void setLiving(std::uint32_t camera, bool living) { living_[camera] = living ? 1 : 0; }

  [[nodiscard]] std::uint32_t cameras() const noexcept override {
    return static_cast<std::uint32_t>(frames_.size());
  }
  [[nodiscard]] StoredRange range(std::uint32_t camera) const noexcept override {
    const auto& frames = frames_[camera];
    return frames.empty() ? StoredRange{} : StoredRange{*frames.begin(), *frames.rbegin()};
  }
  [[nodiscard]] bool holds(std::uint32_t camera, std::uint64_t trigger) const noexcept override {
    return frames_[camera].contains(trigger) || (trigger == held_ && holders_.contains(camera));
  }
  [[nodiscard]] bool living(std::uint32_t camera) const noexcept override {
    return living_[camera] != 0;
  }
  [[nodiscard]] std::uint64_t heldTrigger() const noexcept override { return held_; }
  [[nodiscard]] bool anyStored() const {
    return std::ranges::any_of(frames_, [](const auto& frames) { return !frames.empty(); });
  }

 private:
  std::vector<std::set<std::uint64_t>> frames_;
  std::vector<char> living_;
  std::uint64_t held_ = 0;
  std::set<std::uint32_t> holders_;
};

Command anyCommand(std::uint32_t cameras) {
  return {
      .kind = static_cast<Command::Kind>(anyIn(0, static_cast<int>(Command::Kind::kReplay) + 1)),
      .camera = anyIn(0U, cameras + 2),
      .delay = std::chrono::milliseconds(anyIn(-100, 4000)),
      .rate = static_cast<appliance::Rate>(anyIn(0, 5))};
}

/// A director at a machine where everything happens: deaths, lost frames, late ticks.
class Session {
 public:
  Session() : cameras(anyIn(1U, 8U)), history(cameras) {}

  /// One output period with whatever happens in it.
  Shot anyTick() {
    std::vector<Command> commands;
    if (anyIn(0, 3) == 0) commands.push_back(anyCommand(cameras));
    if (anyIn(0, 12) == 0) commands.push_back(anyCommand(cameras));
    if (anyIn(0, 6) == 0) history.setLiving(anyIn(0U, cameras), anyIn(0, 3) != 0);
    const int triggers = anyIn(0, 3);
    for (int i = 0; i < triggers; ++i) capture(anyBits<std::uint32_t>());
    return tick(commands);
  }

  /// One trigger; the cameras whose bit is set in both halves of @p losses miss it.
  void capture(std::uint32_t losses) {
    ++trigger;
    for (std::uint32_t camera = 0; camera < cameras; ++camera) {
      const bool missed = ((losses & (losses >> 16)) >> camera & 1U) != 0;
      if (history.living(camera) && !missed) history.store(camera, trigger);
    }
  }

  Shot tick(const std::vector<Command>& commands) {
    now += kPeriod;
    const Shot shot = director.tick({.at = now}, kPeriod, history, commands);
    history.hold(shot.hold);
    return shot;
  }

  std::uint32_t cameras;
  LossyHistory history;
  Director director{{.first_view = 3,
                     .history_margin_triggers = 2,
                     .delay_ladder = {std::chrono::milliseconds(500), std::chrono::seconds(2)}}};
  rt::Timestamp now = rt::fromNs(1);
  std::uint64_t trigger = 0;
};

RC_GTEST_PROP(DirectorProperty, ShowsOnlyFramesThatAreStoredOrKeepsTheLastPicture, ()) {
  Session session;
  Shot last;
  for (int i = 0; i < 150; ++i) {
    const Shot shot = session.anyTick();
    RC_ASSERT(shot.camera_wanted < session.cameras);
    RC_ASSERT(shot.camera_shown < session.cameras);
    if (shot.trigger == 0) {
      RC_ASSERT(!session.history.anyStored());
    } else {
      const bool same = shot.trigger == last.trigger && shot.camera_shown == last.camera_shown;
      RC_ASSERT(same || session.history.holds(shot.camera_shown, shot.trigger));
    }
    last = shot;
  }
}

RC_GTEST_PROP(DirectorProperty, SaysSoWheneverAnotherViewThanTheWantedIsShown, ()) {
  Session session;
  for (int i = 0; i < 150; ++i) {
    const Shot shot = session.anyTick();
    if (shot.camera_shown != shot.camera_wanted)
      RC_ASSERT(shot.substitute != appliance::Substitute::kNone);
  }
}

RC_GTEST_PROP(DirectorProperty, LiveNeverGoesBackInTimeWithinOneView, ()) {
  Session session;
  Shot last;
  for (int i = 0; i < 150; ++i) {
    const Shot shot = session.anyTick();
    if (shot.mode == Mode::kLive && last.mode == Mode::kLive &&
        shot.camera_shown == last.camera_shown)
      RC_ASSERT(shot.trigger >= last.trigger);
    last = shot;
  }
}

RC_GTEST_PROP(DirectorProperty, OnePressOfLiveIsLiveAtTheNewestFrame, ()) {
  Session session;
  const int ticks = anyIn(1, 100);
  for (int i = 0; i < ticks; ++i) (void)session.anyTick();
  for (std::uint32_t camera = 0; camera < session.cameras; ++camera)
    session.history.setLiving(camera, true);
  session.capture(0);
  const Shot shot = session.tick({{.kind = Command::Kind::kGoLive}});
  RC_ASSERT(shot.mode == Mode::kLive);
  RC_ASSERT(shot.trigger == session.trigger);
  RC_ASSERT(shot.camera_shown == shot.camera_wanted);
}

RC_GTEST_PROP(DirectorProperty, ASweepEndsWhereItBeganWithinItsTime, ()) {
  Session session;
  for (std::uint32_t i = 0; i < 20; ++i) session.capture(0);
  const int ticks = anyIn(1, 60);
  for (int i = 0; i < ticks; ++i) (void)session.anyTick();
  const Shot frozen =
      session.tick({{.kind = Command::Kind::kGoLive}, {.kind = Command::Kind::kFreezeToggle}});
  Shot shot = session.tick({{.kind = Command::Kind::kSweep}});
  std::set<std::uint32_t> wanted = {shot.camera_wanted};
  // Two ways along the arc at 20 views a second, two ticks of 25 ms for each view.
  for (std::uint32_t i = 0; i < 4 * (session.cameras - 1); ++i) {
    shot = session.tick({});
    wanted.insert(shot.camera_wanted);
  }
  RC_ASSERT(shot.mode == Mode::kFrozen);
  RC_ASSERT(shot.camera_wanted == frozen.camera_wanted);
  RC_ASSERT(shot.trigger == frozen.trigger);
  for (std::uint32_t camera = 0; camera < session.cameras; ++camera)
    if (session.history.holds(camera, shot.trigger)) RC_ASSERT(wanted.contains(camera));
}

RC_GTEST_PROP(DirectorProperty, AFrozenPictureNeverChanges, ()) {
  Session session;
  for (std::uint32_t i = 0; i < 20; ++i) session.capture(0);
  const int ticks = anyIn(1, 60);
  for (int i = 0; i < ticks; ++i) (void)session.anyTick();
  const Shot frozen = session.tick({{.kind = Command::Kind::kFreeze}});
  for (int i = 0; i < 200; ++i) {
    session.capture(anyBits<std::uint32_t>());
    const Shot shot = session.tick({});
    RC_ASSERT(shot.mode == Mode::kFrozen);
    RC_ASSERT(shot.trigger == frozen.trigger);
    RC_ASSERT(shot.camera_shown == frozen.camera_shown);
  }
}

}  // namespace

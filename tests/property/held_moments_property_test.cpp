// Hours of a coach's presses against a true history, in invented time: what is stopped stays what
// it is, a step goes to the next moment or to none, and the way back to live is never lost.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/capture/frame_history.h"
#include "appliance/director/director.h"
#include "appliance/render/history_views.h"
#include "appliance/render/moment_hold.h"
#include "appliance/render/render_loop.h"

namespace {

using namespace appliance;
using enum Command::Kind;

constexpr std::uint32_t kCameras = 5;
constexpr std::uint32_t kSets = 60;
constexpr rt::Nanoseconds kPeriod = std::chrono::milliseconds(25);

/// What a frame's bytes say.
struct Content {
  std::uint64_t camera;
  std::uint64_t trigger;
  friend bool operator==(const Content&, const Content&) = default;
};

/// The history of five cameras which miss frames, die and come back, or deliver a trigger late.
class Cameras {
 public:
  Cameras() {
    history_ = std::move(
        *FrameHistory::create({.frame_bytes = std::vector<std::size_t>(kCameras, sizeof(Content)),
                               .sets = kSets,
                               .in_flight = 2,
                               .reserve = RenderLoop::kPinsPerCamera}));
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      slots_.push_back(history_->camera(i).fillingSlots()[0]);
    }
    late_.resize(kCameras);
    dead_until_.resize(kCameras);
  }

  void fire(std::mt19937_64& random) {
    ++trigger_;
    edges.post(trigger_, rt::fromNs(1) + static_cast<std::int64_t>(trigger_) * kPeriod);
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      if (late_[i]) store(i, *std::exchange(late_[i], std::nullopt));
      if (random() % 2000 == 0) dead_until_[i] = trigger_ + random() % 300;
      if (dead_until_[i] > trigger_ || random() % 50 == 0) continue;
      if (random() % 4 == 0) {
        late_[i] = trigger_;  // still on the wire
      } else {
        store(i, trigger_);
      }
    }
  }
  void fireWell() {
    ++trigger_;
    edges.post(trigger_, rt::fromNs(1) + static_cast<std::int64_t>(trigger_) * kPeriod);
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      late_[i] = std::nullopt;
      dead_until_[i] = 0;
      store(i, trigger_);
    }
  }

  [[nodiscard]] std::uint64_t trigger() const { return trigger_; }
  [[nodiscard]] FrameHistory& history() { return *history_; }
  [[nodiscard]] bool anyHolds(std::uint64_t trigger) const {
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      if (history_->camera(i).holds(trigger)) return true;
    }
    return false;
  }

  EdgeBoard edges;

 private:
  void store(std::uint32_t camera, std::uint64_t trigger) {
    CameraFrames& frames = history_->camera(camera);
    const Content content{.camera = camera, .trigger = trigger};
    std::memcpy(frames.slots()[slots_[camera]].data(), &content, sizeof content);
    const std::uint32_t next = frames.store(slots_[camera], {.trigger = trigger});
    EXPECT_NE(next, slots_[camera]) << "a reader cost the camera a frame";
    slots_[camera] = next;
  }

  std::unique_ptr<FrameHistory> history_;
  std::vector<std::uint32_t> slots_;
  std::vector<std::optional<std::uint64_t>> late_;
  std::vector<std::uint64_t> dead_until_;
  std::uint64_t trigger_ = 0;
};

std::string text(const Shot& shot) {
  return std::string(nameOf(shot.mode)) + " " + std::to_string(shot.trigger) +
         (shot.at_history_end ? " at the end" : "");
}

bool isStopped(const Shot& shot) {
  return shot.mode == Mode::kFrozen || shot.mode == Mode::kSweep;
}

/// What the render loop does with its director, its hold and a picture, once a trigger.
class Session {
 public:
  explicit Session(std::uint64_t seed) : random_(seed) {}

  /// Nothing, or the first thing that is wrong.
  std::optional<std::string> turn() {
    cameras_.fire(random_);
    std::vector<Command> commands;
    if (random_() % 20 == 0) commands.push_back(anyCommand());
    return tick(commands);
  }

  std::optional<std::string> goLive() {
    cameras_.fireWell();
    if (auto wrong = tick({{.kind = kGoLive}})) return wrong;
    if (shot_.mode != Mode::kLive) return "live did not come";
    if (shot_.trigger != cameras_.trigger()) return "live is not the newest moment";
    return std::nullopt;
  }

  /// A press while all cameras deliver.
  std::optional<std::string> press(const Command& command) {
    cameras_.fireWell();
    return tick({command});
  }

  [[nodiscard]] const Shot& shot() const { return shot_; }

 private:
  std::optional<std::string> tick(const std::vector<Command>& commands) {
    now_ += kPeriod;
    const Shot before = shot_;
    shot_ = director_.tick({.at = now_}, kPeriod, hold_, commands);
    hold_.keep(shot_.hold);
    if (auto wrong = wrongPicture(before)) return wrong;
    if (!isStopped(shot_)) return std::nullopt;
    return wrongMoment(before, commands.empty() ? std::nullopt : std::optional(commands[0].kind));
  }

  /// What is shown is what the shot says. Without a frame the screen stays as it is.
  std::optional<std::string> wrongPicture(const Shot& before) {
    if (shot_.trigger == 0) return std::nullopt;
    const auto frame = hold_.tryPin(shot_.camera_shown, shot_.trigger);
    const bool stays = shot_.trigger == before.trigger && shot_.camera_shown == before.camera_shown;
    if (!frame && stays && !isStopped(shot_)) return std::nullopt;
    if (!frame) return "the frame to show is not there";
    Content content{};
    std::memcpy(&content, frame->pixels, sizeof content);
    const Content wanted{.camera = shot_.camera_shown, .trigger = shot_.trigger};
    return content == wanted ? std::nullopt : std::optional<std::string>("another frame's pixels");
  }

  /// A stopped moment is the one that was shown when it was stopped, or the one stepped to.
  std::optional<std::string> wrongMoment(const Shot& before, std::optional<Command::Kind> command) {
    if (shot_.hold != shot_.trigger) return "the moment shown is not the one that is held";
    if (command == kStepBack || command == kStepForward) return wrongStep(before, *command);
    const bool plays = command == kReplay || command == kSlower || command == kSetRate;
    // Playback that reaches the memory's end stops there, and says so.
    const bool ran_out = !isStopped(before) && shot_.at_history_end;
    if (shot_.trigger == before.trigger || plays || ran_out) return std::nullopt;
    return "it moved by itself, from " + text(before) + " to " + text(shot_) + ", command " +
           std::to_string(command ? static_cast<int>(*command) : -1);
  }

  std::optional<std::string> wrongStep(const Shot& before, Command::Kind command) {
    if (shot_.trigger == before.trigger) {
      const bool newest = command == kStepForward && !isNewerThan(before.trigger);
      if (shot_.at_history_end || newest) return std::nullopt;
      return "a step went nowhere, from " + text(before);
    }
    const bool back = command == kStepBack;
    if ((shot_.trigger < before.trigger) != back) return "a step went the other way";
    const auto [low, high] = std::minmax(shot_.trigger, before.trigger);
    for (std::uint64_t between = low + 1; between < high; ++between) {
      if (cameras_.anyHolds(between)) return "a step left a moment out";
    }
    return std::nullopt;
  }

  /// Whether a camera that delivers has a later moment.
  [[nodiscard]] bool isNewerThan(std::uint64_t trigger) const {
    for (std::uint32_t i = 0; i < kCameras; ++i) {
      if (views_.living(i) && views_.range(i).newest > trigger) return true;
    }
    return false;
  }

  Command anyCommand() {
    constexpr std::array kinds = {kGoLive,     kHome,     kFreezeToggle, kDelayLess,   kDelayMore,
                                  kSetDelay,   kStepBack, kStepBack,     kStepForward, kViewLeft,
                                  kViewRight,  kSetView,  kSweep,        kFreeze,      kThaw,
                                  kStartSweep, kSlower,   kSetRate,      kReplay};
    constexpr std::array rates = {Rate::kStill, Rate::kEighth, Rate::kQuarter, Rate::kHalf,
                                  Rate::kFull};
    return {.kind = kinds[random_() % kinds.size()],
            .camera = static_cast<std::uint32_t>(random_() % kCameras),
            .delay = std::chrono::milliseconds(random_() % 2000),
            .rate = rates[random_() % rates.size()]};
  }

  std::mt19937_64 random_;
  Cameras cameras_;
  HistoryViews views_{**cameras_.history().openReader("render", RenderLoop::kPinsPerCamera),
                      cameras_.edges};
  MomentHold hold_{views_};
  Director director_{{.first_view = 2, .delay_ladder = {std::chrono::milliseconds(500)}}};
  rt::Timestamp now_ = rt::fromNs(1);
  Shot shot_;
};

constexpr std::uint64_t kTwoHours = std::uint64_t{2} * 3600 * 40;  // triggers

TEST(HeldMoments, TwoHoursOfPressesShowNoMomentThatNobodyAskedForAndAlwaysFindBackToLive) {
  Session session(20'260'730);
  std::mt19937_64 random(1);
  std::uint64_t stopped = 0;
  for (std::uint64_t turn = 0; turn < kTwoHours; ++turn) {
    const auto wrong = random() % 4000 == 0 ? session.goLive() : session.turn();
    ASSERT_EQ(wrong, std::nullopt) << "at trigger " << turn;
    if (isStopped(session.shot())) ++stopped;
  }
  EXPECT_GT(stopped, kTwoHours / 10) << "the test shows too little";
}

RC_GTEST_PROP(HeldMoments, StayThemselvesInAnyMinute, ()) {
  Session session(*rc::gen::arbitrary<std::uint64_t>());
  for (int turn = 0; turn < 2400; ++turn) {
    const auto wrong = session.turn();
    RC_ASSERT(wrong == std::nullopt);
  }
}

TEST(HeldMoments, AMomentThatIsFrozenForTenTimesTheHistoryIsStillTheSame) {
  Session session(3);
  for (int turn = 0; turn < 100; ++turn) ASSERT_EQ(session.goLive(), std::nullopt);
  ASSERT_EQ(session.press({.kind = kFreezeToggle}), std::nullopt);
  const Shot frozen = session.shot();
  ASSERT_EQ(frozen.mode, Mode::kFrozen);
  for (std::uint32_t turn = 0; turn < 10 * kSets; ++turn) {
    const std::uint32_t view = turn % kCameras;
    ASSERT_EQ(session.press({.kind = kSetView, .camera = view}), std::nullopt);
    ASSERT_EQ(session.shot().mode, Mode::kFrozen);
    ASSERT_EQ(session.shot().trigger, frozen.trigger);
    ASSERT_EQ(session.shot().camera_shown, view) << "every view of the moment stays";
  }
  // The memory has left the moment behind: a step cannot go anywhere, and says so.
  for (const Command::Kind kind : {kStepBack, kStepForward}) {
    ASSERT_EQ(session.press({.kind = kind}), std::nullopt);
    EXPECT_EQ(session.shot().trigger, frozen.trigger);
    EXPECT_TRUE(session.shot().at_history_end);
  }
  ASSERT_EQ(session.goLive(), std::nullopt);
}

}  // namespace

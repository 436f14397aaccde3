#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "appliance/director/arc_path.h"
#include "appliance/director/available.h"
#include "appliance/director/command.h"
#include "appliance/director/playhead.h"
#include "appliance/director/presentation.h"
#include "appliance/director/programme.h"
#include "appliance/director/shot.h"
#include "appliance/director/stored_views.h"
#include "appliance/director/view_choice.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

struct DirectorParameters {
  std::uint32_t first_view = 0;  ///< camera shown at start, from 0
  /// Kept from the history's oldest end: those sets may be recycled before they are pinned.
  std::uint32_t history_margin_triggers = 4;
  double sweep_views_per_second = 20;  ///< views of the arc's mean distance
  /// What the delay keys step through, rising; live stands below the first, the history's end
  /// above the last.
  std::vector<rt::Nanoseconds> delay_ladder;
  /// Without a command for so long the box goes home: live, the middle view. Zero: never.
  rt::Nanoseconds idle_home{};
};

/// Decides which stored moment of which view is shown: pure, composed of a playhead, the arc's
/// path, a programme and the choice of the camera. docs/director.md says what a person sees.
///
/// Its state is small. Time runs: live, or `delay_` behind the newest moment, or by the playhead
/// at a slower rate. Or time is stopped at one moment, which never changes by itself: Shot::hold
/// names it so that its frames are kept. A programme may drive both meanwhile.
///
/// Threads  One: the render thread.
/// RT       RT safe; at most a few hundred calls of StoredViews per tick.
class Director {
 public:
  explicit Director(DirectorParameters parameters)
      : parameters_(std::move(parameters)), view_(parameters_.first_view) {}

  /// The rig's true angles; views that it does not know stand one degree apart.
  void setArc(const ArcPath& arc) RT_SAFE { arc_ = arc; }

  /// Applies the commands since the last tick in order, then decides. At most kMostCommands count.
  [[nodiscard]] Shot tick(const Presentation& picture, rt::Nanoseconds trigger_period,
                          const StoredViews& stored, std::span<const Command> commands) RT_SAFE;

  /// One for each command of the last tick, in their order.
  [[nodiscard]] std::span<const CommandOutcome> outcomes() const RT_SAFE {
    return std::span(outcomes_).first(outcome_count_);
  }

  /// Whether the next vblank may want another picture without any new frame.
  [[nodiscard]] bool moving() const RT_SAFE;

 private:
  /// A second shot: another view, or the view some time earlier, in the same picture.
  struct Comparison {
    Composition composition;
    std::optional<std::uint32_t> camera;  // none: the first shot's
    rt::Nanoseconds delay{};              // behind the first shot
  };
  struct Stop {
    std::uint64_t trigger = 0;
    bool at_memorys_end = false;  // a step beyond the end was asked for
  };

  CommandOutcome apply(const Command& command, const Available& at) RT_SAFE;
  void interruptProgramme(Command::Kind by) RT_SAFE;

  CommandOutcome changeDelay(rt::Nanoseconds delay) RT_SAFE;
  CommandOutcome freeze(const Available& at) RT_SAFE;
  CommandOutcome thaw(const Available& at) RT_SAFE;
  CommandOutcome step(std::int64_t direction, const Available& at) RT_SAFE;
  CommandOutcome play(Rate rate, const Available& at) RT_SAFE;
  CommandOutcome startSweep(const Available& at) RT_SAFE;
  CommandOutcome startReplay(const Command& command, const Available& at) RT_SAFE;
  CommandOutcome compare(const Command& command, const Available& at) RT_SAFE;
  CommandOutcome moveView(std::int32_t direction, const Available& at) RT_SAFE;
  void jump() RT_SAFE;

  [[nodiscard]] rt::Nanoseconds delayNow(const Available& at) const RT_SAFE;
  [[nodiscard]] static std::uint64_t firstStoredFrom(const Available& at,
                                                     std::uint64_t trigger) RT_SAFE;
  [[nodiscard]] bool playsByItself() const RT_SAFE;
  [[nodiscard]] Mode modeNow() const RT_SAFE;
  [[nodiscard]] bool isHome(const Available& at) const RT_SAFE;
  void keepStop(const Available& at) RT_SAFE;
  void runProgramme(const Available& at, rt::Timestamp now) RT_SAFE;
  void keepToMemory(const Available& at) RT_SAFE;
  void followDelay(const Available& at, const Presentation& picture, Shot& shot) RT_SAFE;
  Shot decide(const Available& at, const Presentation& picture) RT_SAFE;
  void decideSecond(const Available& at, Shot& shot) const RT_SAFE;
  [[nodiscard]] Substitute substituteOf(const Shot& shot, const Available& at) const RT_SAFE;

  DirectorParameters parameters_;
  ArcPath arc_;
  ViewChoice choice_;
  Playhead playhead_;

  std::uint32_t view_;                  // wanted, from 0
  rt::Nanoseconds delay_{};             // behind the newest moment at full rate; zero: live
  Rate rate_ = Rate::kFull;             // while time runs; below: the playhead says which moment
  std::optional<Stop> stopped_;         // none: time runs
  std::optional<Programme> programme_;  // drives rate, stop and view
  std::optional<std::uint32_t> return_to_;  // the view that a sweep began with
  std::optional<Comparison> comparison_;
  bool following_ = false;  // the playhead is where the delay wants it

  Shot last_;
  std::optional<rt::Timestamp> last_command_;  // or the first tick
  std::array<CommandOutcome, kMostCommands> outcomes_{};
  std::size_t outcome_count_ = 0;
};

}  // namespace appliance

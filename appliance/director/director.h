#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "appliance/director/command.h"
#include "appliance/director/shot.h"
#include "appliance/director/stored_views.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

struct DirectorParameters {
  std::uint32_t first_view = 0;  ///< camera shown at start, from 0
  /// Kept from the history's oldest end: those sets may be recycled before they are pinned.
  std::uint32_t history_margin_triggers = 4;
  double sweep_views_per_second = 20;
  /// What the delay keys step through, rising; live stands below the first, the history's end
  /// above the last.
  std::vector<rt::Nanoseconds> delay_ladder;
};

/// Decides which stored moment of which view is shown: a pure state machine.
///
/// live     the newest frame of the shown camera; never a step back in time.
/// delayed  the newest moment minus the delay, at most to the history's end.
/// frozen   one moment, kept while capture goes on; where the history's end overtakes it the
///          shot walks along that end and says so (Shot::at_history_end).
/// sweep    the frozen moment while the view goes to the arc's right end, to the left end and
///          back to where it began. Freeze, sweep, step and view keys stop it where it is; live
///          and delay leave it for the view it began with.
///
/// Live, a lost camera is replaced by its nearest living neighbour. In the other modes what
/// counts is who holds the moment: a frame stored before its camera was lost is still
/// shown. A missing frame of the wanted view is bridged by the view's previous ones when
/// delayed (up to kBridgedTriggers), since a jump of the view would be seen and a repeated picture
/// is not; when frozen the moment is what matters and the neighbour shows it.
///
/// Threads  One: the render thread.
/// RT       RT safe; at most a few hundred calls of StoredViews per tick.
class Director {
 public:
  static constexpr std::uint64_t kBridgedTriggers = 3;

  explicit Director(DirectorParameters parameters)
      : parameters_(std::move(parameters)), view_(parameters_.first_view) {}

  /// Applies the commands since the last tick in order, then decides.
  [[nodiscard]] Shot tick(rt::Timestamp now, rt::Nanoseconds trigger_period,
                          const StoredViews& stored, std::span<const Command> commands) RT_SAFE;

 private:
  struct Moment {  // what the history offers at this tick
    rt::Timestamp now;
    rt::Nanoseconds period;
    const StoredViews& stored;
    std::uint32_t cameras;
    StoredRange range;            // over all living cameras; of all when none lives
    std::uint64_t oldest_usable;  // range.oldest and the margin
  };
  struct Choice {
    std::uint32_t camera;
    std::uint64_t trigger;
  };

  static Moment survey(rt::Timestamp now, rt::Nanoseconds period, const StoredViews& stored,
                       std::uint32_t margin_triggers) RT_SAFE;

  void apply(const Command& command, const Moment& at) RT_SAFE;
  bool freeze() RT_SAFE;
  void step(std::int64_t triggers, const Moment& at) RT_SAFE;
  void moveView(std::int32_t direction, const Moment& at) RT_SAFE;
  void changeDelay(rt::Nanoseconds delay) RT_SAFE;

  void advanceSweep(const Moment& at) RT_SAFE;
  Shot decide(const Moment& at) RT_SAFE;
  [[nodiscard]] std::optional<Choice> chooseLive(const Moment& at) const RT_SAFE;
  [[nodiscard]] std::optional<Choice> chooseStored(const Moment& at,
                                                   std::uint64_t trigger) const RT_SAFE;
  template <class Usable>
  [[nodiscard]] std::optional<std::uint32_t> nearest(const Moment& at, Usable usable) const RT_SAFE;

  DirectorParameters parameters_;
  Mode mode_ = Mode::kLive;  // kLive stands for delayed too: delay_ tells
  std::uint32_t view_;       // wanted, from 0
  rt::Nanoseconds delay_{};
  std::uint64_t frozen_trigger_ = 0;
  rt::Timestamp sweep_start_;
  std::uint32_t sweep_from_ = 0;
  Shot last_;
};

}  // namespace appliance

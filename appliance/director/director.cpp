#include "appliance/director/director.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <span>

namespace appliance {
namespace {

constexpr rt::Nanoseconds kLongestDelay = std::chrono::hours(1);

/// Moments around a hole in everybody's memory that are tried in its place.
constexpr std::uint64_t kWidestHole_triggers = 32;

std::uint64_t inTriggers(rt::Nanoseconds delay, rt::Nanoseconds period) {
  return static_cast<std::uint64_t>((delay + period / 2) / period);
}

rt::Nanoseconds inTime(std::uint64_t triggers, rt::Nanoseconds period) {
  return static_cast<std::int64_t>(triggers) * period;
}

using Ladder = std::span<const rt::Nanoseconds>;

rt::Nanoseconds rungAbove(Ladder ladder, rt::Nanoseconds delay, rt::Nanoseconds longest) {
  const auto rung = std::ranges::upper_bound(ladder, delay);
  const rt::Nanoseconds above = rung == ladder.end() ? longest : *rung;
  return std::max(delay, std::min(above, longest));
}

rt::Nanoseconds rungBelow(Ladder ladder, rt::Nanoseconds delay, rt::Nanoseconds longest) {
  const auto rung = std::ranges::lower_bound(ladder, std::min(delay, longest));
  return rung == ladder.begin() ? rt::Nanoseconds::zero() : *(rung - 1);
}

/// Goes on to another moment, for which the view of the sweep's start is the one to see.
bool leavesTheMoment(Command::Kind kind) {
  using enum Command::Kind;
  return kind == kGoLive || kind == kHome || kind == kDelayLess || kind == kDelayMore ||
         kind == kSetDelay;
}

}  // namespace

Director::Moment Director::survey(rt::Timestamp now, rt::Nanoseconds period,
                                  const StoredViews& stored,
                                  std::uint32_t margin_triggers) RT_SAFE {
  const std::uint32_t cameras = stored.cameras();
  StoredRange of_living;
  StoredRange of_all;
  const auto widen = [](StoredRange& sum, const StoredRange& range) {
    sum.oldest = sum.empty() ? range.oldest : std::min(sum.oldest, range.oldest);
    sum.newest = std::max(sum.newest, range.newest);
  };
  for (std::uint32_t camera = 0; camera < cameras; ++camera) {
    const StoredRange range = stored.range(camera);
    if (range.empty()) continue;
    widen(of_all, range);
    if (stored.living(camera)) widen(of_living, range);
  }
  const StoredRange range = of_living.empty() ? of_all : of_living;
  return {.now = now,
          .period = std::max(period, rt::Nanoseconds(1)),
          .stored = stored,
          .cameras = cameras,
          .range = range,
          .oldest_usable = std::min(range.oldest + margin_triggers, range.newest)};
}

Shot Director::tick(rt::Timestamp now, rt::Nanoseconds trigger_period, const StoredViews& stored,
                    std::span<const Command> commands) RT_SAFE {
  const Moment at = survey(now, trigger_period, stored, parameters_.history_margin_triggers);
  if (at.cameras == 0) return last_ = Shot{};
  view_ = std::min(view_, at.cameras - 1);
  for (const Command& command : commands) apply(command, at);
  if (mode_ == Mode::kSweep) advanceSweep(at);
  return last_ = decide(at);
}

void Director::apply(const Command& command, const Moment& at) RT_SAFE {
  using enum Command::Kind;
  const bool interrupted_sweep = mode_ == Mode::kSweep;
  if (interrupted_sweep) {
    mode_ = Mode::kFrozen;
    if (leavesTheMoment(command.kind)) view_ = sweep_from_;
  }
  const rt::Nanoseconds longest = inTime(at.range.newest - at.oldest_usable, at.period);
  switch (command.kind) {
    case kGoLive:
      changeDelay({});
      break;
    case kHome:
      changeDelay({});
      view_ = (at.cameras - 1) / 2;
      break;
    case kFreezeToggle:
      if (interrupted_sweep) break;
      if (mode_ == Mode::kFrozen) {
        mode_ = Mode::kLive;
      } else {
        (void)freeze();
      }
      break;
    case kDelayLess:
      changeDelay(rungBelow(parameters_.delay_ladder, delay_, longest));
      break;
    case kDelayMore:
      changeDelay(rungAbove(parameters_.delay_ladder, delay_, longest));
      break;
    case kSetDelay:
      changeDelay(command.delay);
      break;
    case kStepBack:
      step(-1, at);
      break;
    case kStepForward:
      step(+1, at);
      break;
    case kViewLeft:
      moveView(-1, at);
      break;
    case kViewRight:
      moveView(+1, at);
      break;
    case kSetView:
      if (command.camera < at.cameras) view_ = command.camera;
      break;
    case kSweep:
      if (interrupted_sweep || !freeze()) break;
      mode_ = Mode::kSweep;
      sweep_start_ = at.now;
      sweep_from_ = view_;
      break;
  }
}

/// False when nothing was shown yet: there is no moment to stop at.
bool Director::freeze() RT_SAFE {
  if (mode_ == Mode::kFrozen) return true;
  if (last_.trigger == 0) return false;
  frozen_trigger_ = last_.trigger;
  mode_ = Mode::kFrozen;
  return true;
}

void Director::step(std::int64_t triggers, const Moment& at) RT_SAFE {
  if (!freeze()) return;
  const auto wanted = static_cast<std::int64_t>(frozen_trigger_) + triggers;
  frozen_trigger_ =
      static_cast<std::uint64_t>(std::clamp(wanted, static_cast<std::int64_t>(at.oldest_usable),
                                            static_cast<std::int64_t>(at.range.newest)));
}

void Director::moveView(std::int32_t direction, const Moment& at) RT_SAFE {
  // Beside a substitute the next view is the substitute's neighbour: every press moves.
  const bool substituted = last_.substitute != Substitute::kNone && last_.camera_wanted == view_;
  const std::uint32_t from = substituted ? last_.camera_shown : view_;
  for (std::int64_t camera = std::int64_t{from} + direction; camera >= 0 && camera < at.cameras;
       camera += direction) {
    const auto next = static_cast<std::uint32_t>(camera);
    const bool usable =
        mode_ == Mode::kFrozen ? at.stored.holds(next, frozen_trigger_) : at.stored.living(next);
    if (!usable) continue;
    view_ = next;
    return;
  }
}

void Director::changeDelay(rt::Nanoseconds delay) RT_SAFE {
  delay_ = std::clamp(delay, rt::Nanoseconds::zero(), kLongestDelay);
  mode_ = Mode::kLive;
}

/// A triangle over the arc: the position follows from the time alone, so that a late tick
/// skips views and never stretches the walk.
void Director::advanceSweep(const Moment& at) RT_SAFE {
  const double whole_walk = 2.0 * (at.cameras - 1);
  const double elapsed_s = std::chrono::duration<double>(at.now - sweep_start_).count();
  const double walked = std::max(0.0, elapsed_s * parameters_.sweep_views_per_second);
  if (!(walked < whole_walk)) {
    view_ = sweep_from_;
    mode_ = Mode::kFrozen;
    return;
  }
  const std::uint32_t whole = 2 * (at.cameras - 1);
  const std::uint32_t place = (sweep_from_ + static_cast<std::uint32_t>(walked)) % whole;
  view_ = place < at.cameras ? place : whole - place;
}

Shot Director::decide(const Moment& at) RT_SAFE {
  Shot shot{.mode = mode_, .camera_wanted = view_, .camera_shown = view_};
  std::optional<Choice> choice;
  if (mode_ != Mode::kLive) {
    shot.at_history_end = frozen_trigger_ < at.oldest_usable;
    frozen_trigger_ = std::max(frozen_trigger_, at.oldest_usable);
    shot.delay = inTime(at.range.newest - std::min(frozen_trigger_, at.range.newest), at.period);
    choice = chooseStored(at, frozen_trigger_);
  } else if (delay_ > rt::Nanoseconds::zero()) {
    shot.mode = Mode::kDelayed;
    const std::uint64_t longest = at.range.newest - at.oldest_usable;
    const std::uint64_t delay = inTriggers(delay_, at.period);
    shot.at_history_end = delay > longest;
    shot.delay = shot.at_history_end ? inTime(longest, at.period) : delay_;
    choice = chooseStored(at, at.range.newest - std::min(delay, longest));
  } else {
    choice = chooseLive(at);
  }
  if (choice) {
    shot.camera_shown = choice->camera;
    shot.trigger = choice->trigger;
  }
  const bool lost = !at.stored.living(view_);
  const bool stale = shot.mode == Mode::kLive && lost;
  if (shot.camera_shown != view_ || stale)
    shot.substitute = lost ? Substitute::kLost : Substitute::kNoFrame;
  return shot;
}

std::optional<Director::Choice> Director::chooseLive(const Moment& at) const RT_SAFE {
  const auto stores = [&](std::uint32_t camera) { return !at.stored.range(camera).empty(); };
  auto camera = nearest(at, [&](std::uint32_t c) { return at.stored.living(c) && stores(c); });
  if (!camera) camera = nearest(at, stores);  // nobody lives: the last picture stays
  if (!camera) return std::nullopt;
  const std::uint64_t newest = at.stored.range(*camera).newest;
  const bool backwards = last_.mode == Mode::kLive && last_.camera_shown == *camera &&
                         last_.trigger > newest && at.stored.holds(*camera, last_.trigger);
  return Choice{*camera, backwards ? last_.trigger : newest};
}

std::optional<Director::Choice> Director::chooseStored(const Moment& at,
                                                       std::uint64_t trigger) const RT_SAFE {
  if (at.range.empty()) return std::nullopt;
  if (mode_ == Mode::kLive) {  // delayed: time moves, so an earlier picture of the view will do
    for (std::uint64_t back = 0; back <= kBridgedTriggers && back < trigger; ++back) {
      if (at.stored.holds(view_, trigger - back)) return Choice{view_, trigger - back};
    }
  }
  const auto holder = [&](std::uint64_t of) {
    return nearest(at, [&](std::uint32_t camera) { return at.stored.holds(camera, of); });
  };
  if (const auto camera = holder(trigger)) return Choice{*camera, trigger};
  for (std::uint64_t away = 1; away <= kWidestHole_triggers; ++away) {
    if (trigger >= at.range.oldest + away) {
      if (const auto camera = holder(trigger - away)) return Choice{*camera, trigger - away};
    }
    if (trigger + away <= at.range.newest) {
      if (const auto camera = holder(trigger + away)) return Choice{*camera, trigger + away};
    }
  }
  return chooseLive(at);
}

/// The wanted view, or the usable one nearest to it. Of two equally near ones the side
/// shown before stays, else left.
template <class Usable>
std::optional<std::uint32_t> Director::nearest(const Moment& at, Usable usable) const RT_SAFE {
  if (usable(view_)) return view_;
  for (std::uint32_t away = 1; away < at.cameras; ++away) {
    const bool left = view_ >= away && usable(view_ - away);
    const bool right = view_ + away < at.cameras && usable(view_ + away);
    if (left && right) return last_.camera_shown > view_ ? view_ + away : view_ - away;
    if (left) return view_ - away;
    if (right) return view_ + away;
  }
  return std::nullopt;
}

}  // namespace appliance

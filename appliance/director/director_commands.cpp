// How commands change the director's state. What is shown then is decided in director.cpp.

#include <algorithm>
#include <array>
#include <chrono>

#include "appliance/director/delay_ladder.h"
#include "appliance/director/director.h"

namespace appliance {
namespace {

constexpr rt::Nanoseconds kLongestDelay = std::chrono::hours(1);

/// Goes on to another moment and returns to the view from which the sweep started.
bool leavesTheMoment(Command::Kind kind) {
  using enum Command::Kind;
  return kind == kGoLive || kind == kHome || kind == kDelayLess || kind == kDelayMore ||
         kind == kSetDelay || kind == kThaw || kind == kSlower || kind == kSetRate ||
         kind == kReplay;
}

bool changesTheView(Command::Kind kind) {
  using enum Command::Kind;
  return kind == kViewLeft || kind == kViewRight || kind == kSetView;
}

}  // namespace

CommandOutcome Director::apply(const Command& command, const Available& at) RT_SAFE {
  using enum Command::Kind;
  const bool stops = command.kind == kSetRate && command.rate == Rate::kStill;
  const Command::Kind kind = stops ? kFreeze : command.kind;
  const bool walking = programme_ && stopped_;
  interruptProgramme(kind);
  switch (kind) {
    case kGoLive:
      return changeDelay({});
    case kHome:
      view_ = (at.cameras - 1) / 2;
      comparison_.reset();
      return changeDelay({});
    case kFreezeToggle:
      if (walking) return CommandOutcome::kApplied;
      return stopped_ ? thaw(at) : freeze(at);
    case kFreeze:
      return freeze(at);
    case kThaw:
      return thaw(at);
    case kDelayLess:
      return changeDelay(rungBelow(parameters_.delay_ladder, delayNow(at), at.longestDelay()));
    case kDelayMore:
      return changeDelay(rungAbove(parameters_.delay_ladder, delayNow(at), at.longestDelay()));
    case kSetDelay:
      return changeDelay(command.delay);
    case kStepBack:
      return step(-1, at);
    case kStepForward:
      return step(+1, at);
    case kViewLeft:
      return moveView(-1, at);
    case kViewRight:
      return moveView(+1, at);
    case kSetView:
      if (command.camera >= at.cameras) return CommandOutcome::kNoSuchView;
      view_ = command.camera;
      return CommandOutcome::kApplied;
    case kSweep:
      return walking ? CommandOutcome::kApplied : startSweep(at);
    case kStartSweep:
      return return_to_ ? CommandOutcome::kApplied : startSweep(at);
    case kSlower:
      return play(nextSlower(stopped_ ? Rate::kFull : rate_), at);
    case kSetRate:
      return play(command.rate, at);
    case kReplay:
      return startReplay(command, at);
    case kCompare:
      return compare(command, at);
  }
  return CommandOutcome::kApplied;
}

/// Each command ends a walk around a stopped moment; the view stays where it is then. A playback
/// goes on if only the view changes.
void Director::interruptProgramme(Command::Kind by) RT_SAFE {
  if (!programme_) return;
  if (by == Command::Kind::kStartSweep && return_to_) return;
  if (by == Command::Kind::kCompare || (!stopped_ && changesTheView(by))) return;
  programme_.reset();
  if (return_to_ && leavesTheMoment(by)) view_ = *return_to_;
  return_to_.reset();
}

/// Another stretch of time is shown from now on.
void Director::jump() RT_SAFE {
  following_ = false;
  choice_.reset();
}

rt::Nanoseconds Director::delayNow(const Available& at) const RT_SAFE {
  return playsByItself() ? at.ageOf(playhead_.trigger()) : delay_;
}

CommandOutcome Director::changeDelay(rt::Nanoseconds delay) RT_SAFE {
  delay_ = std::clamp(delay, rt::Nanoseconds::zero(), kLongestDelay);
  rate_ = Rate::kFull;
  stopped_.reset();
  jump();
  return CommandOutcome::kApplied;
}

CommandOutcome Director::freeze(const Available& at) RT_SAFE {
  if (stopped_) return CommandOutcome::kApplied;
  if (last_.trigger == 0) return CommandOutcome::kNoPictureYet;
  stopped_ = Stop{.trigger = last_.trigger};
  if (at.anyHolds(last_.trigger)) return CommandOutcome::kApplied;
  stopped_ = Stop{.trigger = firstStoredFrom(at, last_.trigger), .at_memorys_end = true};
  return CommandOutcome::kAtMemorysEnd;
}

/// Slow motion goes on from the stopped moment, as long as the next moments are stored.
CommandOutcome Director::thaw(const Available& at) RT_SAFE {
  if (!stopped_) return CommandOutcome::kApplied;
  if (stopped_->trigger < at.oldest_usable) rate_ = Rate::kFull;
  playhead_.seek(stopped_->trigger);
  stopped_.reset();
  jump();
  return CommandOutcome::kApplied;
}

CommandOutcome Director::step(std::int64_t direction, const Available& at) RT_SAFE {
  if (const auto stopped = freeze(at); stopped != CommandOutcome::kApplied) return stopped;
  std::uint64_t trigger = stopped_->trigger;
  for (std::uint64_t tried = 0; tried < ViewChoice::kWidestHole_triggers; ++tried) {
    if (trigger < at.oldest_usable || (direction < 0 && trigger == at.oldest_usable)) break;
    if (direction > 0 && trigger >= at.range.newest) return CommandOutcome::kNothingNewer;
    trigger = direction > 0 ? trigger + 1 : trigger - 1;
    if (!at.anyHolds(trigger)) continue;
    stopped_ = Stop{.trigger = trigger};
    return CommandOutcome::kApplied;
  }
  stopped_->at_memorys_end = true;
  return CommandOutcome::kAtMemorysEnd;
}

CommandOutcome Director::play(Rate rate, const Available& at) RT_SAFE {
  if (last_.trigger == 0) return CommandOutcome::kNoPictureYet;
  if (!stopped_ && rate == rate_) return CommandOutcome::kApplied;
  if (stopped_ && stopped_->trigger < at.oldest_usable) {
    stopped_->at_memorys_end = true;
    return CommandOutcome::kAtMemorysEnd;
  }
  const bool goes_on = playsByItself();
  if (!goes_on) playhead_.seek(stopped_ ? stopped_->trigger : last_.trigger);
  stopped_.reset();
  if (rate == Rate::kFull) return changeDelay(at.ageOf(playhead_.trigger()));
  rate_ = rate;
  if (!goes_on) jump();
  return CommandOutcome::kApplied;
}

/// To the right end, to the left end, and back.
CommandOutcome Director::startSweep(const Available& at) RT_SAFE {
  if (const auto stopped = freeze(at); stopped != CommandOutcome::kApplied) return stopped;
  const double begin_deg = arc_.angleOf(view_);
  Programme sweep;
  for (const double angle_deg : {arc_.length_deg(), 0.0, begin_deg}) {
    (void)sweep.add({.trigger = stopped_->trigger,
                     .angle_deg = angle_deg,
                     .speed_deg_per_s = parameters_.sweep_views_per_second * arc_.meanStep_deg(),
                     .hold = rt::Nanoseconds::zero(),
                     .rate = Rate::kStill});
  }
  sweep.start(begin_deg);
  programme_ = sweep;
  return_to_ = view_;
  return CommandOutcome::kApplied;
}

/// Slower than real time, the replay of a long stretch may be overtaken by the memory's end.
CommandOutcome Director::startReplay(const Command& command, const Available& at) RT_SAFE {
  if (last_.trigger == 0) return CommandOutcome::kNoPictureYet;
  const std::uint64_t end = at.range.newest;
  const std::uint64_t back = at.inTriggers(std::clamp(command.delay, at.period, kLongestDelay));
  const std::uint64_t begin = end - std::min(back, end - at.oldest_usable);
  Programme replay;
  (void)replay.add({.trigger = begin, .rate = std::max(command.rate, Rate::kEighth)});
  (void)replay.add({.trigger = end, .rate = Rate::kFull});
  replay.start(arc_.angleOf(view_));
  programme_ = replay;
  stopped_.reset();
  playhead_.seek(begin);
  jump();
  return CommandOutcome::kApplied;
}

CommandOutcome Director::compare(const Command& command, const Available& at) RT_SAFE {
  if (command.composition.layout == Layout::kSingle) {
    comparison_.reset();
    return CommandOutcome::kApplied;
  }
  std::optional<std::uint32_t> camera;
  if (command.camera != Command::kSameView) {
    if (command.camera >= at.cameras) return CommandOutcome::kNoSuchView;
    camera = command.camera;
  }
  comparison_ =
      Comparison{.composition = command.composition,
                 .camera = camera,
                 .delay = std::clamp(command.delay, rt::Nanoseconds::zero(), kLongestDelay)};
  return CommandOutcome::kApplied;
}

CommandOutcome Director::moveView(std::int32_t direction, const Available& at) RT_SAFE {
  // Beside a substitute the next view is the substitute's neighbour: every press moves.
  const bool substituted = last_.substitute != Substitute::kNone && last_.camera_wanted == view_;
  const std::uint32_t from = substituted ? last_.camera_shown : view_;
  for (std::int64_t camera = std::int64_t{from} + direction; camera >= 0 && camera < at.cameras;
       camera += direction) {
    const auto next = static_cast<std::uint32_t>(camera);
    const bool usable =
        stopped_ ? at.stored.holds(next, stopped_->trigger) : at.stored.living(next);
    if (!usable || !at.stored.sees(next)) continue;
    view_ = next;
    break;
  }
  return CommandOutcome::kApplied;
}

}  // namespace appliance

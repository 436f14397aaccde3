#include "appliance/director/director.h"

#include <algorithm>

namespace appliance {
Shot Director::tick(const Presentation& picture, rt::Nanoseconds trigger_period,
                    const StoredViews& stored, std::span<const Command> commands) RT_SAFE {
  const Available at = lookAt(stored, trigger_period, parameters_.history_margin_triggers);
  outcome_count_ = 0;
  if (at.cameras == 0) return last_ = Shot{};
  view_ = std::min(view_, at.cameras - 1);
  if (arc_.cameras() != at.cameras) arc_ = ArcPath::even(at.cameras);
  if (!last_command_ || !commands.empty()) last_command_ = picture.at;

  keepStop(at);
  playhead_.advance(picture, at.period);
  for (const Command& command : commands.first(std::min(commands.size(), kMostCommands)))
    outcomes_[outcome_count_++] = apply(command, at);
  if (parameters_.idle_home > rt::Nanoseconds::zero() &&
      picture.at - *last_command_ >= parameters_.idle_home && !isHome(at))
    (void)apply({.kind = Command::Kind::kHome}, at);
  if (programme_) runProgramme(at, picture.at);
  if (playsByItself()) keepToMemory(at);
  last_ = decide(at, picture);
  playhead_.setRate(stopped_ ? Rate::kStill : rate_);
  return last_;
}

bool Director::moving() const RT_SAFE {
  return programme_.has_value() || (!stopped_ && modeNow() != Mode::kLive);
}

bool Director::playsByItself() const RT_SAFE {
  return !stopped_ && (programme_ || rate_ != Rate::kFull);
}

Mode Director::modeNow() const RT_SAFE {
  if (stopped_) return programme_ ? Mode::kSweep : Mode::kFrozen;
  if (rate_ != Rate::kFull) return Mode::kSlow;
  return programme_ || delay_ > rt::Nanoseconds::zero() ? Mode::kDelayed : Mode::kLive;
}

bool Director::isHome(const Available& at) const RT_SAFE {
  return !comparison_ && modeNow() == Mode::kLive && view_ == (at.cameras - 1) / 2;
}

/// If the new moment's frames could not be kept, the moment before stays: see Shot::hold.
void Director::keepStop(const Available& at) RT_SAFE {
  const std::uint64_t held = at.stored.heldTrigger();
  if (!stopped_ || held == 0 || held == stopped_->trigger) return;
  stopped_ = Stop{.trigger = held, .at_memorys_end = true};
}

void Director::runProgramme(const Available& at, rt::Timestamp now) RT_SAFE {
  const Programme::Step step =
      programme_->step(now, stopped_ ? stopped_->trigger : playhead_.trigger());
  if (step.rate == Rate::kStill) {
    if (!stopped_) stopped_ = Stop{.trigger = playhead_.trigger()};
  } else {
    stopped_.reset();
    rate_ = step.rate;
  }
  if (step.angle_deg) {
    const auto usable = [&](std::uint32_t camera) {
      return at.stored.sees(camera) &&
             (stopped_ ? at.stored.holds(camera, stopped_->trigger) : at.stored.living(camera));
    };
    view_ = arc_.nearest(*step.angle_deg, usable).value_or(view_);
  }
  if (!step.ended) return;
  programme_.reset();
  if (return_to_) view_ = *return_to_;
  return_to_.reset();
  if (!stopped_) jump();
}

/// The moment, or the first later one that is stored.
std::uint64_t Director::firstStoredFrom(const Available& at, std::uint64_t trigger) RT_SAFE {
  const std::uint64_t from = std::max(trigger, at.oldest_usable);
  for (std::uint64_t away = 0; away <= ViewChoice::kWidestHole_triggers; ++away)
    if (at.anyHolds(from + away)) return from + away;
  return trigger;
}

/// If the next moment of a playback is no longer stored, the playback stops. To catch up it would
/// have to play faster than requested.
void Director::keepToMemory(const Available& at) RT_SAFE {
  if (playhead_.trigger() > at.range.newest) playhead_.seek(at.range.newest);
  if (playhead_.trigger() >= at.oldest_usable) return;
  stopped_ = Stop{.trigger = firstStoredFrom(at, playhead_.trigger()), .at_memorys_end = true};
  programme_.reset();
}

void Director::followDelay(const Available& at, const Presentation& picture, Shot& shot) RT_SAFE {
  const std::uint64_t longest = at.range.newest - at.oldest_usable;
  const std::uint64_t delay = at.inTriggers(delay_);
  shot.at_history_end = delay > longest;
  shot.delay = shot.at_history_end ? at.inTime(longest) : delay_;
  const std::uint64_t wanted = at.range.newest - std::min(delay, longest);
  const bool evenly = following_ && picture.refresh > rt::Nanoseconds::zero();
  if (evenly) {
    playhead_.keepNear(wanted);
  } else {
    playhead_.seek(wanted);
  }
  following_ = true;
}

Shot Director::decide(const Available& at, const Presentation& picture) RT_SAFE {
  Shot shot{.mode = modeNow(), .rate = rate_, .camera_wanted = view_, .camera_shown = view_};
  const ViewChoice::Frame last{.camera = last_.camera_shown, .trigger = last_.trigger};
  std::optional<ViewChoice::Frame> frame;
  if (stopped_) {
    shot.rate = Rate::kStill;
    shot.hold = stopped_->trigger;
    shot.at_history_end = stopped_->at_memorys_end;
    shot.delay = at.ageOf(stopped_->trigger);
    frame = ViewChoice::stopped(at, view_, last, stopped_->trigger);
  } else if (shot.mode == Mode::kLive) {
    frame = choice_.live(at, view_, last, picture.at);
  } else {
    if (playsByItself()) {
      shot.delay = at.ageOf(playhead_.trigger());
    } else {
      followDelay(at, picture, shot);
    }
    frame = choice_.played(at, view_, last, playhead_.trigger(), picture.at);
  }
  // The last picture is better than a moment that was not requested.
  if (!frame && last.trigger != 0) frame = last;
  if (frame) {
    shot.camera_shown = frame->camera;
    shot.trigger = frame->trigger;
  }
  shot.substitute = substituteOf(shot, at);
  if (comparison_) decideSecond(at, shot);
  return shot;
}

/// If the second frame is missing, the first one is shown alone: no other moment replaces it. While
/// live, its camera may deliver a few microseconds later, so one trigger earlier is accepted.
void Director::decideSecond(const Available& at, Shot& shot) const RT_SAFE {
  const std::uint64_t back = at.inTriggers(comparison_->delay);
  const std::uint32_t camera = comparison_->camera.value_or(shot.camera_shown);
  shot.second_earlier = comparison_->delay;
  shot.second_missing = true;
  if (shot.trigger <= back || camera >= at.cameras) return;
  const std::uint64_t wanted = shot.trigger - back;
  if (stopped_ && back != 0) shot.hold_second = wanted;
  const bool earlier_will_do = !stopped_ && wanted > 1;
  for (const std::uint64_t trigger : {wanted, earlier_will_do ? wanted - 1 : wanted}) {
    if (!at.stored.holds(camera, trigger)) continue;
    shot.composition = comparison_->composition;
    shot.second = {.camera = camera, .trigger = trigger};
    shot.second_missing = false;
    return;
  }
}

Substitute Director::substituteOf(const Shot& shot, const Available& at) const RT_SAFE {
  const bool living = at.stored.living(view_);
  const bool stale = shot.mode == Mode::kLive && !living;
  if (shot.camera_shown == view_ && !stale) return Substitute::kNone;
  if (!at.stored.sees(view_)) return Substitute::kCannotSee;
  const bool unsteady = shot.mode == Mode::kLive && !at.stored.range(view_).empty();
  return !living || unsteady ? Substitute::kLost : Substitute::kNoFrame;
}

}  // namespace appliance

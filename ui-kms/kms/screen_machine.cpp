#include "ui-kms/kms/screen_machine.h"

#include <algorithm>

namespace ui::kms {

void ScreenMachine::enter(State state) {
  if (state_ == State::kLost) return;
  const bool lit = state == State::kLighting || state == State::kShowing;
  if (takesPictures() && !lit) ++losses_;
  if (state == State::kLighting) ++changes_;
  if (state == State::kReleased || state == State::kLost) master_ = false;
  if (state != State::kShowing) pending_since_.reset();
  state_ = state;
}

ScreenMachine::Task ScreenMachine::next(rt::Timestamp now) {
  if (state_ == State::kReleased || state_ == State::kLost) return Task::kNone;
  if (pending_since_ && now - *pending_since_ > kFlipPatience) onConfused(now);
  const bool due = now >= next_;
  if (!master_) return due ? Task::kTakeMaster : Task::kNone;
  if (hotplug_) return Task::kLook;
  if (!due) return Task::kNone;
  return state_ == State::kSearching ? Task::kLook : Task::kGlance;
}

void ScreenMachine::onMaster(bool held, rt::Timestamp now) {
  master_ = held;
  hotplug_ = held;  // what was seen before another program had the screen no longer counts
  next_ = now + kPoll;
}

void ScreenMachine::onLook(const Sight& sight, rt::Timestamp now) {
  hotplug_ = false;
  next_ = now + kPoll;
  if (!sight.usable) {
    enter(State::kSearching);
  } else if (!takesPictures() || !sight.unchanged || !sight.link_good) {
    enter(State::kLighting);
  }
}

void ScreenMachine::onGlance(bool unchanged, rt::Timestamp now) {
  next_ = now + kPoll;
  if (!unchanged) hotplug_ = true;
}

void ScreenMachine::onHotplug() {
  hotplug_ = true;
  backoff_ = kFirstBackoff;
}

void ScreenMachine::onCommitted(rt::Timestamp now) {
  if (state_ == State::kLighting) enter(State::kShowing);
  if (!pending_since_) pending_since_ = now;
}

void ScreenMachine::onFlip() {
  pending_since_.reset();
  backoff_ = kFirstBackoff;
}

void ScreenMachine::onRefused(rt::Timestamp now) {
  enter(State::kSearching);
  next_ = now + backoff_;
  backoff_ = std::min(2 * backoff_, kLastBackoff);
}

void ScreenMachine::onConfused(rt::Timestamp now) {
  enter(State::kSearching);
  next_ = now;
}

void ScreenMachine::onMasterLost(rt::Timestamp now) {
  enter(State::kSearching);
  master_ = false;
  next_ = now + kPoll;
}

void ScreenMachine::take(rt::Timestamp now) {
  if (state_ != State::kReleased) return;
  enter(State::kSearching);
  next_ = now;
}

}  // namespace ui::kms

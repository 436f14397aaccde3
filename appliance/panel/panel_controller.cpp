#include "appliance/panel/panel_controller.h"

#include <algorithm>

namespace appliance {
namespace {

struct Meaning {
  Command::Kind kind;
  bool repeats;
};

/// In the order of hal::Button.
constexpr std::array<Meaning, hal::kButtonNames.size()> kMeanings = {{
    {Command::Kind::kGoLive, false},
    {Command::Kind::kFreezeToggle, false},
    {Command::Kind::kDelayLess, true},
    {Command::Kind::kDelayMore, true},
    {Command::Kind::kStepBack, true},
    {Command::Kind::kStepForward, true},
    {Command::Kind::kViewLeft, true},
    {Command::Kind::kViewRight, true},
    {Command::Kind::kSweep, false},
}};

const Meaning& meaningOf(hal::Button button) {
  return kMeanings[static_cast<std::size_t>(button)];
}

}  // namespace

std::optional<PanelCommand> PanelController::onEvent(const hal::ButtonEvent& event) {
  bool& down = down_[static_cast<std::size_t>(event.button)];
  if (event.pressed == down) return std::nullopt;
  down = event.pressed;
  if (!event.pressed) {
    if (repetition_ && repetition_->button == event.button) repetition_.reset();
    return std::nullopt;
  }
  next_check_ = event.at + kRepeatEvery;
  const Meaning& meaning = meaningOf(event.button);
  repetition_.reset();
  if (meaning.repeats) repetition_ = Repetition{event.button, event.at + kRepeatAfter};
  return PanelCommand{{.kind = meaning.kind}, event.at};
}

std::optional<PanelCommand> PanelController::onTime(rt::Timestamp now) {
  if (!nextTime() || now < *nextTime()) return std::nullopt;
  for (std::size_t i = 0; i < down_.size(); ++i) {
    const auto button = static_cast<hal::Button>(i);
    if (!down_[i] || level_(button)) continue;
    down_[i] = false;
    if (repetition_ && repetition_->button == button) repetition_.reset();
  }
  next_check_ = now + kRepeatEvery;
  if (!repetition_ || now < repetition_->due) return std::nullopt;
  const PanelCommand repeated{{.kind = meaningOf(repetition_->button).kind}, repetition_->due};
  repetition_->due += kRepeatEvery;
  if (repetition_->due <= now) repetition_->due = now + kRepeatEvery;
  return repeated;
}

std::optional<rt::Timestamp> PanelController::nextTime() const {
  if (std::ranges::find(down_, true) == down_.end()) return std::nullopt;
  return repetition_ ? std::min(repetition_->due, next_check_) : next_check_;
}

}  // namespace appliance

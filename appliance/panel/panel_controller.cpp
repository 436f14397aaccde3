#include "appliance/panel/panel_controller.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace appliance {
namespace {

enum class WhenHeld : std::uint8_t { kNothing, kRepeats, kGoesHome };

struct Meaning {
  hal::Button button;
  Command::Kind kind;
  WhenHeld held;
};

constexpr std::array<Meaning, hal::kButtons.size()> kMeanings = {{
    {hal::Button::kLive, Command::Kind::kGoLive, WhenHeld::kGoesHome},
    {hal::Button::kFreeze, Command::Kind::kFreezeToggle, WhenHeld::kNothing},
    {hal::Button::kDelayLess, Command::Kind::kDelayLess, WhenHeld::kRepeats},
    {hal::Button::kDelayMore, Command::Kind::kDelayMore, WhenHeld::kRepeats},
    {hal::Button::kStepBack, Command::Kind::kStepBack, WhenHeld::kRepeats},
    {hal::Button::kStepForward, Command::Kind::kStepForward, WhenHeld::kRepeats},
    {hal::Button::kViewLeft, Command::Kind::kViewLeft, WhenHeld::kRepeats},
    {hal::Button::kViewRight, Command::Kind::kViewRight, WhenHeld::kRepeats},
    {hal::Button::kSweep, Command::Kind::kSweep, WhenHeld::kNothing},
    {hal::Button::kSpeed, Command::Kind::kSlower, WhenHeld::kNothing},
}};
static_assert(std::ranges::all_of(kMeanings, [](const Meaning& meaning) {
  return &meaning == &kMeanings[static_cast<std::size_t>(meaning.button)];
}));

const Meaning& meaningOf(hal::Button button) {
  return kMeanings[static_cast<std::size_t>(button)];
}

}  // namespace

std::optional<PanelCommand> PanelController::onEvent(const hal::ButtonEvent& event) {
  if (event.pressed == down_[static_cast<std::size_t>(event.button)]) return std::nullopt;
  if (!event.pressed) {
    letGo(event.button);
    return std::nullopt;
  }
  // A check that is due already stays so: quick presses must not postpone it forever.
  if (!nextTime()) next_check_ = event.at + kRepeatEvery;
  down_[static_cast<std::size_t>(event.button)] = true;
  const Meaning& meaning = meaningOf(event.button);
  held_.reset();
  if (meaning.held == WhenHeld::kRepeats) held_ = {event.button, event.at + kRepeatAfter};
  if (meaning.held == WhenHeld::kGoesHome) held_ = {event.button, event.at + kLongPress};
  return PanelCommand{{.kind = meaning.kind}, event.at};
}

std::optional<PanelCommand> PanelController::onTime(rt::Timestamp now) {
  if (!nextTime() || now < *nextTime()) return std::nullopt;
  for (std::size_t i = 0; i < down_.size(); ++i) {
    const auto button = static_cast<hal::Button>(i);
    if (down_[i] && !level_(button)) letGo(button);
  }
  next_check_ = now + kRepeatEvery;
  if (!held_ || now < held_->due) return std::nullopt;
  const Meaning& meaning = meaningOf(held_->button);
  const rt::Timestamp due = held_->due;
  if (meaning.held == WhenHeld::kGoesHome) {
    held_.reset();
    return PanelCommand{{.kind = Command::Kind::kHome}, due};
  }
  held_->due += kRepeatEvery;
  if (held_->due <= now) held_->due = now + kRepeatEvery;
  return PanelCommand{{.kind = meaning.kind}, due};
}

void PanelController::letGo(hal::Button button) {
  down_[static_cast<std::size_t>(button)] = false;
  if (held_ && held_->button == button) held_.reset();
}

std::optional<rt::Timestamp> PanelController::nextTime() const {
  if (std::ranges::find(down_, true) == down_.end()) return std::nullopt;
  return held_ ? std::min(held_->due, next_check_) : next_check_;
}

}  // namespace appliance

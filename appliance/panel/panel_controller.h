#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

#include "appliance/director/command.h"
#include "hal/button_panel.h"
#include "rt/clock.h"

namespace appliance {

/// A command and the instant that caused it: button_to_commit is measured from there.
struct PanelCommand {
  Command command;
  rt::Timestamp cause;  ///< the contact's change, or when holding it was due
};

/// Turns the panel's contacts into commands: a pure state machine.
///
/// A press acts immediately; its release does nothing. Step, delay and view keys repeat while held:
/// after kRepeatAfter, then every kRepeatEvery. `live` held for kLongPress goes home, once. Only
/// the key pressed last repeats or goes home, and only while it stays down. Keys held together have
/// no meaning of their own: each press acts alone, so that a stuck key blocks no other. A second
/// press of a key that is down already is bounce and ignored. A release that got lost is found by
/// reading the contacts of all keys that are down, kRepeatEvery and before each repetition.
///
/// Threads  One: the panel thread.
/// RT       Not RT safe (the level is read from hardware).
class PanelController {
 public:
  static constexpr rt::Nanoseconds kRepeatAfter = std::chrono::milliseconds(400);
  static constexpr rt::Nanoseconds kRepeatEvery = std::chrono::milliseconds(125);
  static constexpr rt::Nanoseconds kLongPress = std::chrono::milliseconds(1500);

  /// Whether the contact is closed now: hal::ButtonPanel::isPressed().
  using Level = std::function<bool(hal::Button)>;

  explicit PanelController(Level level) : level_(std::move(level)) {}

  /// What a change of contact asks for, if anything.
  [[nodiscard]] std::optional<PanelCommand> onEvent(const hal::ButtonEvent& event);

  /// What holding a key asks for at @p now, if anything; at most one command per call, late
  /// repetitions are not made up for.
  [[nodiscard]] std::optional<PanelCommand> onTime(rt::Timestamp now);

  /// When onTime() is to be called next; nothing while no key is down.
  [[nodiscard]] std::optional<rt::Timestamp> nextTime() const;

 private:
  /// What comes if the key pressed last stays down.
  struct Held {
    hal::Button button;
    rt::Timestamp due;
  };

  void letGo(hal::Button button);

  Level level_;
  std::array<bool, hal::kButtons.size()> down_{};
  std::optional<Held> held_;
  rt::Timestamp next_check_;  // of the contacts, while a key is down
};

}  // namespace appliance

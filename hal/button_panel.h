#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace hal {

/// The keys of the panel.
enum class Button : std::uint8_t {
  kLive,
  kFreeze,  ///< stop and go on
  kDelayLess,
  kDelayMore,
  kStepBack,  ///< one trigger earlier
  kStepForward,
  kViewLeft,  ///< the neighbouring camera
  kViewRight,
  kSweep,  ///< walk around the stopped moment
  kSpeed,  ///< slow motion
};

struct ButtonRow {
  Button button;
  std::string_view name;  ///< on the panel, in scripts and in the names of GPIO lines
};

inline constexpr std::array<ButtonRow, 10> kButtons = {{{Button::kLive, "live"},
                                                        {Button::kFreeze, "freeze"},
                                                        {Button::kDelayLess, "delay-less"},
                                                        {Button::kDelayMore, "delay-more"},
                                                        {Button::kStepBack, "step-back"},
                                                        {Button::kStepForward, "step-forward"},
                                                        {Button::kViewLeft, "view-left"},
                                                        {Button::kViewRight, "view-right"},
                                                        {Button::kSweep, "sweep"},
                                                        {Button::kSpeed, "speed"}}};
static_assert(std::ranges::all_of(kButtons, [](const ButtonRow& row) {
  return &row == &kButtons[static_cast<std::size_t>(row.button)];
}));

[[nodiscard]] constexpr std::string_view nameOf(Button button) {
  return kButtons[static_cast<std::size_t>(button)].name;
}

struct ButtonEvent {
  Button button;
  bool pressed;
  rt::Timestamp at;  ///< when the contact changed, as the kernel (or the script) stamped it
};

enum class Lamp : std::uint8_t { kLive, kDelayed, kFrozen };

/// What a panel is opened with; each backend takes its own.
struct PanelSettings {
  std::string script;                     ///< "scripted": its file
  std::string button_prefix = "button-";  ///< "gpiod": a button's line is named this and its name
  std::string lamp_prefix = "lamp-";      ///< "gpiod": and live, delayed or frozen
  bool active_low = true;                 ///< "gpiod": a pressed button is the low level
  std::chrono::milliseconds debounce{10};
  bool operator==(const PanelSettings&) const = default;
};

struct LampRow {
  Lamp lamp;
  std::string_view name;  ///< on the panel and in the names of GPIO lines
};

inline constexpr std::array<LampRow, 3> kLamps = {
    {{Lamp::kLive, "live"}, {Lamp::kDelayed, "delayed"}, {Lamp::kFrozen, "frozen"}}};
static_assert(std::ranges::all_of(kLamps, [](const LampRow& row) {
  return &row == &kLamps[static_cast<std::size_t>(row.lamp)];
}));

/// The buttons and lamps of one box.
///
/// Threads  One caller at a time: the panel thread.
/// RT       waitEvent() blocks; nothing here is for a real-time thread.
/// Errors   A panel that vanished delivers no more events; alive() says so.
class ButtonPanel {
 public:
  virtual ~ButtonPanel() = default;

  /// Debounced presses and releases in order; nothing after @p timeout.
  [[nodiscard]] virtual std::optional<ButtonEvent> waitEvent(rt::Nanoseconds timeout) = 0;

  /// The contact's level now, read from the hardware: "held" is never inferred from edges.
  [[nodiscard]] virtual bool isPressed(Button button) = 0;

  virtual void setLamp(Lamp lamp, bool on) = 0;

  [[nodiscard]] virtual bool alive() const = 0;
};

}  // namespace hal

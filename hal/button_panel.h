#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace hal {

/// The keys of the panel. Names are what stands on the panel and in scripts.
enum class Button : std::uint8_t {
  kLive,         ///< live
  kFreeze,       ///< freeze: stop and go on
  kDelayLess,    ///< delay-less
  kDelayMore,    ///< delay-more
  kStepBack,     ///< step-back: one trigger earlier
  kStepForward,  ///< step-forward
  kViewLeft,     ///< view-left: the neighbouring camera
  kViewRight,    ///< view-right
  kSweep,        ///< sweep: walk around the stopped moment
};
inline constexpr std::array<std::string_view, 9> kButtonNames = {
    "live",         "freeze",    "delay-less", "delay-more", "step-back",
    "step-forward", "view-left", "view-right", "sweep"};

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

#pragma once

#include <expected>
#include <memory>
#include <optional>
#include <string>

#include <termios.h>

#include "hal/button_panel.h"

namespace hal::emulated {

/// The panel's buttons as keys of the terminal on standard input, for a demo at a desk.
///
/// A terminal has no key releases: each key is a press and, at the next call, its release.
/// Terminal settings are put back on destruction; the interrupt key keeps working.
class TerminalPanel final : public ButtonPanel {
 public:
  /// Errors   Standard input is not a terminal.
  [[nodiscard]] static std::expected<std::unique_ptr<ButtonPanel>, std::string> open();

  ~TerminalPanel() override;

  [[nodiscard]] std::optional<ButtonEvent> waitEvent(rt::Nanoseconds timeout) override;
  [[nodiscard]] bool isPressed(Button button) override { return pressed_ == button; }
  void setLamp(Lamp /*lamp*/, bool /*on*/) override {}  // the screen's own line shows the mode
  [[nodiscard]] bool alive() const override { return alive_; }

 private:
  explicit TerminalPanel(const termios& before) : before_(before) {}
  [[nodiscard]] std::optional<Button> readKey(rt::Nanoseconds timeout);

  termios before_;
  std::optional<Button> pressed_;
  bool alive_ = true;
};

}  // namespace hal::emulated

#pragma once

#include <array>
#include <expected>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/button_panel.h"

namespace hal::emulated {

/// One change of one contact, relative to the start of the script.
struct ScriptedChange {
  rt::Nanoseconds after{0};
  Button button = Button::kLive;
  bool pressed = false;
  friend bool operator==(const ScriptedChange&, const ScriptedChange&) = default;
};

/// How long a tap holds its button down.
inline constexpr rt::Nanoseconds kTap = std::chrono::milliseconds(50);

/// Reads lines "<seconds> press|release|tap <button-name>", '#' starts a comment; the result
/// is in order of time. An error names @p origin, the line and what stands there.
[[nodiscard]] std::expected<std::vector<ScriptedChange>, std::string> parsePanelScript(
    std::string_view text, std::string_view origin);

/// A lamp switched, and when.
struct LampChange {
  Lamp lamp = Lamp::kLive;
  bool on = false;
  rt::Timestamp at;
};

/// A panel whose buttons are pressed by a script, on time.
///
/// Threads  As hal::ButtonPanel; it has none of its own: waitEvent() sleeps until the next
///          change. Events carry the scripted instant, even when they are fetched late.
/// Errors   After the last change the panel stays alive and silent.
class ScriptedPanel final : public ButtonPanel {
 public:
  [[nodiscard]] static std::expected<ScriptedPanel, std::string> open(
      const std::filesystem::path& script, rt::Timestamp start);
  /// @p changes in order of time, as parsePanelScript() gives them.
  ScriptedPanel(std::vector<ScriptedChange> changes, rt::Timestamp start);

  [[nodiscard]] std::optional<ButtonEvent> waitEvent(rt::Nanoseconds timeout) override;
  [[nodiscard]] bool isPressed(Button button) override;
  void setLamp(Lamp lamp, bool on) override;
  [[nodiscard]] bool alive() const override { return true; }

  /// Every lamp change so far.
  [[nodiscard]] const std::vector<LampChange>& lampChanges() const { return lamp_changes_; }
  [[nodiscard]] bool isLit(Lamp lamp) const;

 private:
  std::vector<ScriptedChange> changes_;
  rt::Timestamp start_;
  std::size_t next_ = 0;
  std::vector<LampChange> lamp_changes_;
};

}  // namespace hal::emulated

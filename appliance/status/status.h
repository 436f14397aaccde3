#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "appliance/capture/camera_status.h"
#include "appliance/capture/genlock_status.h"
#include "appliance/director/command.h"
#include "appliance/director/shot.h"
#include "appliance/status/status_section.h"
#include "hal/display.h"

namespace appliance {

/// One snapshot of the running daemon. Views count from 0 here, from 1 for people and on the bus.
/// Texts are UTF-8: D-Bus refuses others.
struct Status {
  Mode mode = Mode::kLive;
  std::uint32_t view_wanted = 0;
  std::uint32_t view_shown = 0;
  std::uint32_t delay_ms = 0;
  std::uint32_t history_ms = 0;      ///< how far back the stored moments reach
  std::array<double, 3> target_m{};  ///< of the shown moment
  std::string target_origin;         ///< how that point is known: "measured", "set by hand" ...
  double shown_hz = 0;               ///< distinct frame sets a second
  std::uint64_t triggers = 0;
  std::uint64_t frames_lost = 0;
  std::uint64_t frames_away = 0;
  std::uint64_t frames_incomplete = 0;
  std::uint64_t frames_unattributed = 0;  ///< no trigger is known to have caused them
  std::uint64_t pictures_skipped = 0;     ///< the display was not ready for them
  std::vector<CameraStatus> cameras;
  GenlockStatus genlock;
  std::string genlock_text;             ///< the same in one line
  Word genlock_word = Word::kNothing;   ///< what the line says first
  std::vector<Remark> degraded;         ///< one per thing that is less than configured
  std::vector<StatusSection> sections;  ///< of the parts that are not in every box
  std::string renderer;
  hal::ScreenState screen = hal::ScreenState::kShowing;
  std::string screen_message;  ///< why nothing or less is shown, and what to do; may be empty
  Word screen_word = Word::kNothing;  ///< what the message says
  std::string source_path;  ///< how frames reach the renderer: "dma-buf" or "upload: <why>"
};

[[nodiscard]] std::string_view nameOf(hal::ScreenState state);

/// @p line without the numbers after its first colon: "sensor: silent for 7.2 s" is the same
/// trouble as "sensor: silent for 7.1 s".
[[nodiscard]] std::string withoutNumbers(std::string_view line);

/// One JSON object with the names of the fields above; views from 1. A section is an object of its
/// line and its values, named after its key.
[[nodiscard]] std::string toJson(const Status& status);

/// What the control interface shows.
///
/// Threads  status(): the thread that serves the control interface.
class StatusSource {
 public:
  virtual ~StatusSource() = default;
  [[nodiscard]] virtual Status status() const = 0;
  /// One JSON object of everything that is counted, by name.
  [[nodiscard]] virtual std::string metrics() const = 0;
};

/// Takes the requests of the control interface, which has checked them.
///
/// Threads  The thread that serves the control interface.
/// Errors   false, or no id: refused because too many requests wait already.
class ControlSink {
 public:
  virtual ~ControlSink() = default;
  /// Each command that was accepted gets one answer with this id.
  [[nodiscard]] virtual std::optional<CommandId> command(const Command& command) = 0;
  [[nodiscard]] virtual std::optional<CommandAnswer> nextAnswer() = 0;
  /// Readable while answers wait.
  [[nodiscard]] virtual int answersFd() const = 0;
  /// Rig frame, metres; finite.
  [[nodiscard]] virtual bool setTarget(const std::array<double, 3>& target_m) = 0;
  /// From the shown moment on, the measured target is used again.
  virtual void releaseTarget() = 0;
  /// From the next picture on, the rig of a rig file's @p text is used; @p name stands for the file
  /// in messages. Returns what was ignored in it, one line each; or why the rig is refused.
  [[nodiscard]] virtual std::expected<std::vector<std::string>, Phrase> loadRig(
      const std::string& text, const std::string& name) = 0;
  /// True: another program may use the screen; false: the box takes it back.
  virtual void setScreenReleased(bool released) = 0;
};

}  // namespace appliance

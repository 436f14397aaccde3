#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/screen_status.h"
#include "rt/clock.h"
#include "rt/result.h"
#include "ui-kms/kms/device.h"
#include "ui-kms/kms/hotplug_monitor.h"
#include "ui-kms/kms/mode_choice.h"
#include "ui-kms/kms/output.h"
#include "ui-kms/kms/screen_machine.h"

namespace ui::kms {

/// Why nothing or less is shown; the texts are those that hal::ScreenTrouble names.
struct Trouble {
  hal::ScreenTrouble what = hal::ScreenTrouble::kNone;
  std::string subject = {};
  std::string detail = {};
  int os_errno = 0;
};

struct ScreenConfig {
  std::string device;            ///< /dev/dri/cardN; empty: the first with a screen
  std::optional<ModeSpec> mode;  ///< none: the best for the trigger rate
  double trigger_hz = 0;         ///< 0: none
};

/// One screen of one card, kept lit: carries out what the ScreenMachine says.
///
/// Threads  One, that of the calls.
/// RT       attend() is quick while all is well; a screen that comes or goes takes it tens of
///          milliseconds, and a mode that is set may take the driver longer.
/// Errors   open(): one line. No screen, no permission to show and a refusing driver are states:
///          trouble() says which, and attend() goes on trying.
class Screen {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<Screen>, std::string> open(
      const ScreenConfig& config);

  /// Releases the card immediately: a driver's library may keep a copy of the descriptor for
  /// longer.
  ~Screen() { device_->dropMaster(); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Does what is due: takes the card, looks for screens, notices what changed.
  void attend(rt::Timestamp now);
  /// Appends the flips since the last call. Never waits.
  void readFlips(std::vector<FlipEvent>& flips);

  [[nodiscard]] bool takesPictures() const { return machine_.takesPictures(); }
  /// The mode that is lit, or that the next show() sets; none before the first screen.
  [[nodiscard]] const std::optional<drmModeModeInfo>& mode() const { return mode_; }
  /// Another number than before: what the screen shows is not what was shown last.
  [[nodiscard]] std::uint64_t changes() const { return machine_.changes(); }
  /// Another number than before: what was committed until then is gone.
  [[nodiscard]] std::uint64_t losses() const { return machine_.losses(); }

  /// Shows @p framebuffer, of the mode's size, from the next vblank on, and sets the mode where
  /// that is due. The flip carries @p serial. @p fence: as Output::flip().
  /// Errors: kBusy, try again; kDeviceLost, attend() and draw again.
  [[nodiscard]] rt::Result<void> show(std::uint32_t framebuffer, int fence, std::uint64_t serial,
                                      rt::Timestamp now);

  void release();
  void take(rt::Timestamp now) { machine_.take(now); }

  [[nodiscard]] ScreenMachine::State state() const { return machine_.state(); }
  [[nodiscard]] const Device& device() const { return *device_; }
  /// As Output::lastVblank().
  [[nodiscard]] std::optional<Vblank> lastVblank() const {
    return output_ ? output_->lastVblank() : std::nullopt;
  }
  [[nodiscard]] bool takesFences() const { return output_ && output_->takesFences(); }

  [[nodiscard]] Trouble trouble() const;
  /// "HDMI-A-1, 1920x1080 at 60.00 Hz, /dev/dri/card0 (i915)".
  [[nodiscard]] std::string description() const;

 private:
  Screen(ScreenConfig config, std::unique_ptr<Device> device, rt::Timestamp now)
      : config_(std::move(config)), device_(std::move(device)), machine_(now) {}

  void look(rt::Timestamp now);
  void glance(rt::Timestamp now);
  [[nodiscard]] std::optional<Connector> seek() const;
  [[nodiscard]] std::optional<drmModeModeInfo> firstPossible(const Output& output) const;
  void leaveOutput();
  [[nodiscard]] rt::Error onFailure(int error, rt::Timestamp now);

  ScreenConfig config_;
  std::unique_ptr<Device> device_;
  HotplugMonitor hotplug_;
  ScreenMachine machine_;
  std::optional<Output> output_;
  std::optional<drmModeModeInfo> mode_;
  Trouble trouble_;  // as it was found last
};

}  // namespace ui::kms

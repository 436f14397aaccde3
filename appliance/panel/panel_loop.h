#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <stop_token>

#include "appliance/director/shot.h"
#include "appliance/panel/panel_controller.h"
#include "hal/button_panel.h"

namespace appliance {

/// Connects the panel: passes its events and the time to the controller, the controller's commands
/// on, and the mode to the lamps.
///
/// Threads  run(): the `panel` thread. lost(): any thread.
/// Errors   A panel that vanishes is reported by lost(); the picture goes on without it.
class PanelLoop {
 public:
  using Give = std::function<void(const PanelCommand&)>;
  using ModeNow = std::function<Mode()>;

  /// @p give takes each command, @p mode says what is shown: both on the panel thread.
  PanelLoop(hal::ButtonPanel& panel, Give give, ModeNow mode);

  void run(const std::stop_token& stop);

  [[nodiscard]] bool lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  void turn();
  void followMode();

  hal::ButtonPanel& panel_;
  Give give_;
  ModeNow mode_;
  PanelController controller_;
  std::optional<hal::Lamp> lit_;
  std::atomic<bool> lost_{false};
};

}  // namespace appliance

#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/kernel/support/gpio_sim.h"
#include "tests/support/child_process.h"

namespace test {

/// Every program of the box on the devices of the test kernel: kagamid on its trigger line, its
/// panel and its screen, cameras behind a bridge on the trigger line.
///
/// Errors   The constructor fails the test and leaves running() false.
class WholeBox {
 public:
  static constexpr int kCameras = 4;
  static constexpr int kWidthPx = 320;
  static constexpr int kHeightPx = 256;

  /// @p folder: where rig, trace and logs are to be.
  explicit WholeBox(std::string folder);

  [[nodiscard]] bool running() const { return running_; }

  /// Presses a button shortly, as a finger does.
  void tap(const std::string& button);
  /// Until a picture of this mode was handed to the screen; false where that takes too long.
  [[nodiscard]] bool waitForMode(const std::string& mode);
  /// Until the lamp is lit or not; false where that takes too long.
  [[nodiscard]] bool waitForLamp(const std::string& mode, bool lit) const;
  [[nodiscard]] bool triggerLevel() const { return chip_.level(kTriggerLine); }

  /// Ends every program, the daemon first.
  void stop();

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::optional<int> daemon_exit;
  std::optional<int> emulator_exit;
  std::string daemon_output;

 private:
  static constexpr const char* kTriggerLine = "trigger";
  static constexpr const char* kLoopBackLine = "trigger-back";

  std::string folder_;
  GpioSim chip_;
  std::unique_ptr<ChildProcess> emulator_;
  std::unique_ptr<ChildProcess> bridge_;
  std::unique_ptr<ChildProcess> daemon_;
  bool running_ = false;
};

}  // namespace test

#pragma once

#include <expected>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hal/trigger_line.h"

namespace hal::gpiod {

struct TriggerLineSettings {
  std::vector<std::string> lines;  ///< names; one pulse goes out on all of them together
  bool active_low = false;         ///< active is the low level: an inverting driver follows
};

/// Claims output lines of one GPIO chip as the trigger, driven inactive from the first moment.
/// One ioctl moves all of them: a chip with one output register moves them at the same instant.
/// Destruction drives them inactive before it lets go of them; what a line does after that is up
/// to the chip, and to the pull-down resistor on the wire.
///
/// Threads  As hal::TriggerLine.
/// RT       setActive() is one ioctl on a chip that the CPU writes itself; nothing is allocated
///          unless the chip is gone.
/// Errors   Here: a line that is absent, named twice, held by another program, behind an expander,
/// or on
///          another chip than the first. While running: kDeviceLost when the chip is gone.
/// @p sysfs where the kernel's device tree is; another folder in tests.
[[nodiscard]] std::expected<std::unique_ptr<TriggerLine>, std::string> openTriggerLine(
    const TriggerLineSettings& settings, const std::filesystem::path& sysfs = "/sys");

}  // namespace hal::gpiod

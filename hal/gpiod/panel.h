#pragma once

#include <expected>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hal/button_panel.h"

namespace hal::gpiod {

/// What opened, and what of the panel is less than it could be: a line each, for a person.
struct OpenedPanel {
  std::unique_ptr<ButtonPanel> panel;
  std::vector<std::string> notes;
};

/// Claims the lines of the panel's buttons and lamps, on whatever chips they are. The kernel
/// debounces; a press is stamped when the contact came to rest.
///
/// A button that is held while the panel opens is named and not reported as a press; its release
/// is. Behind an expander a panel works, and a note says so.
///
/// Threads  As hal::ButtonPanel.
/// Errors   No button at all, a name that exists twice, or a line that another program holds.
///          Missing single buttons and missing lamps are notes. While running: when a chip
///          goes, alive() turns false, its buttons are not pressed and its lamps stay as they are.
/// @p sysfs where the kernel's device tree is; another folder in tests.
[[nodiscard]] std::expected<OpenedPanel, std::string> openButtonPanel(
    const PanelSettings& settings, const std::filesystem::path& sysfs = "/sys");

}  // namespace hal::gpiod

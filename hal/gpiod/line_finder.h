#pragma once

#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hal::gpiod {

/// One named line of a GPIO chip, as the kernel lists it.
struct ListedLine {
  std::string name;
  std::string chip;        ///< "gpiochip0"
  std::string chip_label;  ///< the chip's maker's name
  unsigned offset = 0;     ///< within the chip
  std::string consumer;    ///< who holds the line; empty: it is free
  std::string bus;         ///< what an expander hangs on (expanderBus()); empty: no expander
};

/// All named lines of this machine, and why some could not be looked at.
struct LineList {
  std::vector<ListedLine> lines;
  std::vector<std::string> refused;  ///< "gpiochip1: Permission denied"
};

/// Looks at every chip there is now.
[[nodiscard]] LineList listLines(const std::filesystem::path& sysfs = "/sys");

/// The one line of that name. Pure.
///
/// Errors  Not there (with the nearest names), there twice, or held by another program. Each starts
///         with @p key, the setting that names the line.
[[nodiscard]] std::expected<ListedLine, std::string> findLine(const LineList& list,
                                                              const std::string& name,
                                                              const std::string& key);

/// The line if the list has exactly one of that name and no program holds it; none if it is absent.
/// Pure.
[[nodiscard]] std::expected<std::optional<ListedLine>, std::string> findOptionalLine(
    const LineList& list, const std::string& name, const std::string& key);

}  // namespace hal::gpiod

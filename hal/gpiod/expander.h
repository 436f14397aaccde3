#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace hal::gpiod {

/// The bus that a GPIO chip hangs on, if a level takes messages to get there: "i2c", "spi",
/// "usb" and the like. Such a chip is an expander: its edges come when the bus has time for them.
/// None for chips whose registers the CPU writes itself.
///
/// Found by walking from the chip's device up to the root of the device tree, because the
/// expander may be a function of a larger device on that bus.
///
/// @p sysfs where the kernel's device tree is: "/sys", another folder in tests.
/// @p chip  "gpiochip0". A chip that is not there hangs on nothing.
[[nodiscard]] std::optional<std::string> expanderBus(const std::filesystem::path& sysfs,
                                                     const std::string& chip);

}  // namespace hal::gpiod

#include "hal/gpiod/expander.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace hal::gpiod {
namespace {

constexpr std::array<std::string_view, 9> kMessageBuses = {
    "i2c", "spi", "usb", "hid", "serial", "w1", "mdio_bus", "spmi", "greybus"};

/// The name of the bus or class that a device's folder belongs to; empty for plain folders.
std::string subsystemOf(const std::filesystem::path& device) {
  std::error_code none;
  return std::filesystem::read_symlink(device / "subsystem", none).filename().string();
}

}  // namespace

std::optional<std::string> expanderBus(const std::filesystem::path& sysfs,
                                       const std::string& chip) {
  std::error_code absent;
  const auto root = std::filesystem::canonical(sysfs, absent);
  if (absent) return std::nullopt;
  auto device = std::filesystem::canonical(root / "bus" / "gpio" / "devices" / chip, absent);
  for (; !absent && device != root && device.has_relative_path(); device = device.parent_path()) {
    std::string bus = subsystemOf(device);
    if (std::ranges::find(kMessageBuses, bus) != kMessageBuses.end()) return bus;
  }
  return std::nullopt;
}

}  // namespace hal::gpiod

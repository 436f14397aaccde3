#pragma once

#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace test {

/// The kernel's device tree as a folder: what /sys would show for GPIO chips on several buses.
class DeviceTree {
 public:
  DeviceTree() {
    for (const char* bus : {"i2c", "spi", "usb", "gpio", "pci", "platform"})
      std::filesystem::create_directories(root() / "bus" / bus / "devices");
  }

  /// A device at @p path under /devices, of bus @p bus.
  void add(const std::string& path, const std::string& bus) const {
    const auto folder = root() / "devices" / path;
    std::filesystem::create_directories(folder);
    std::filesystem::create_symlink(root() / "bus" / bus, folder / "subsystem");
  }

  /// A GPIO chip as the child of the device at @p parent.
  void addChip(const std::string& parent, const std::string& chip) const {
    add(parent + "/" + chip, "gpio");
    std::filesystem::create_symlink("../../../devices/" + parent + "/" + chip,
                                    root() / "bus/gpio/devices" / chip);
  }

  [[nodiscard]] std::filesystem::path root() const { return folder_ / "sys"; }

 private:
  TemporaryFolder folder_;
};

}  // namespace test

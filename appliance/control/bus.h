#pragma once

#include <expected>
#include <memory>
#include <string>

#include <systemd/sd-bus.h>

namespace appliance {

struct BusCloser {
  void operator()(sd_bus* bus) const { sd_bus_flush_close_unref(bus); }
};
using Bus = std::unique_ptr<sd_bus, BusCloser>;

inline constexpr const char* kControlPath = "/org/kagami/Kagami1";
inline constexpr const char* kControlInterface = "org.kagami.Kagami1";

/// @p which: "system", "session" or a D-Bus address.
/// Errors   One line: which bus, why not.
[[nodiscard]] std::expected<Bus, std::string> openBus(const std::string& which);

/// How messages name that bus.
[[nodiscard]] std::string describeBus(const std::string& which);

}  // namespace appliance

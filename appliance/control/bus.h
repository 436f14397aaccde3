#pragma once

#include <expected>
#include <memory>
#include <string>

#include <systemd/sd-bus.h>

namespace appliance {

struct BusCloser {
  void operator()(sd_bus* bus) const { sd_bus_flush_close_unref(bus); }
};
/// The connection of a client: closing waits until everything was sent.
using Bus = std::unique_ptr<sd_bus, BusCloser>;

struct ServerBusCloser {
  void operator()(sd_bus* bus) const { sd_bus_close_unref(bus); }
};
/// The connection of the daemon: closing never waits for a bus that no longer reads.
using ServerBus = std::unique_ptr<sd_bus, ServerBusCloser>;

inline constexpr const char* kControlPath = "/org/kagami/Kagami1";
inline constexpr const char* kStatusInterface = "org.kagami.Kagami1";
inline constexpr const char* kControlInterface = "org.kagami.Kagami1.Control";
inline constexpr const char* kMaintenanceInterface = "org.kagami.Kagami1.Maintenance";
inline constexpr const char* kJobInterface = "org.kagami.Kagami1.Job";

/// @p which: "system", "session" or a D-Bus address.
/// Errors   One line: which bus, why not.
[[nodiscard]] std::expected<Bus, std::string> openBus(const std::string& which);

/// The same for the daemon. Never blocks: whether the bus answers shows later.
[[nodiscard]] std::expected<ServerBus, std::string> startBus(const std::string& which);

/// How messages name that bus.
[[nodiscard]] std::string describeBus(const std::string& which);

}  // namespace appliance

#include "appliance/control/bus.h"

#include <cstring>

namespace appliance {
namespace {

template <class Held>
int openAddress(const std::string& address, Held& bus) {
  sd_bus* made = nullptr;
  if (const int r = sd_bus_new(&made); r < 0) return r;
  bus.reset(made);
  if (const int r = sd_bus_set_address(made, address.c_str()); r < 0) return r;
  if (const int r = sd_bus_set_bus_client(made, 1); r < 0) return r;
  return sd_bus_start(made);
}

template <class Held>
int openNamed(int (*open_it)(sd_bus**), Held& bus) {
  sd_bus* made = nullptr;
  const int r = open_it(&made);
  bus.reset(made);
  return r;
}

template <class Held>
std::expected<Held, std::string> open(const std::string& which) {
  Held bus;
  const int r = which == "system"    ? openNamed(&sd_bus_open_system, bus)
                : which == "session" ? openNamed(&sd_bus_open_user, bus)
                                     : openAddress(which, bus);
  if (r < 0)
    return std::unexpected("cannot reach " + describeBus(which) + " (" + std::strerror(-r) + ")");
  return bus;
}

}  // namespace

std::expected<Bus, std::string> openBus(const std::string& which) {
  return open<Bus>(which);
}

std::expected<ServerBus, std::string> startBus(const std::string& which) {
  return open<ServerBus>(which);
}

std::string describeBus(const std::string& which) {
  if (which == "system" || which == "session") return "the " + which + " bus";
  return "the bus " + which;
}

}  // namespace appliance

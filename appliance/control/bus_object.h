#pragma once

#include <cstdint>
#include <string>

#include <systemd/sd-bus.h>

namespace appliance {

/// An interface of an object that is shown on the bus, whenever there is one. All of it outlives
/// the control server. Callbacks are made by onMethod() and onProperty(); who may call is decided
/// by the bus's policy, per interface (systemd/org.kagami.Kagami1.conf).
struct BusObject {
  const char* path;
  const char* interface;
  const sd_bus_vtable* vtable;
  void* target;  ///< what the callbacks get
};

/// Where a job is shown: what a method that starts one answers.
[[nodiscard]] inline std::string jobPath(std::uint32_t id) {
  return "/org/kagami/Kagami1/jobs/" + std::to_string(id);
}

}  // namespace appliance

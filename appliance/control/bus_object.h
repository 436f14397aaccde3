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

/// The object of the part `depth`, for the part and for its clients.
inline constexpr const char* kDepthPath = "/org/kagami/Kagami1/depth";
inline constexpr const char* kDepthInterface = "org.kagami.Kagami1.Depth";

/// Every job is an object below this path.
inline constexpr const char* kJobsPath = "/org/kagami/Kagami1/jobs";

/// The path of a job: the answer of a method that starts one.
[[nodiscard]] inline std::string jobPath(std::uint32_t id) {
  return std::string(kJobsPath) + "/" + std::to_string(id);
}

}  // namespace appliance

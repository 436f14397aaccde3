#pragma once

#include <cerrno>
#include <exception>
#include <new>
#include <string>

#include <systemd/sd-bus.h>

#include "appliance/words/phrase.h"

namespace appliance {

/// The D-Bus error that says @p word: "org.kagami.Kagami1.Error.NoSuchView".
[[nodiscard]] inline std::string errorName(Word word) {
  return "org.kagami.Kagami1.Error." + std::string(nameOf(word));
}

/// The answer of a method that was refused.
inline int refuse(sd_bus_error* error, const Phrase& why) {
  return sd_bus_error_set(error, errorName(why.word).c_str(), textOf(why).c_str());
}

/// The result of @p body. An exception becomes an error for the caller: it must not cross sd-bus,
/// which is written in C.
template <class Body>
int guarded(sd_bus_error* error, Body body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return -ENOMEM;
  } catch (const std::exception& fault) {
    return sd_bus_error_set(error, SD_BUS_ERROR_FAILED, fault.what());
  }
}

/// @p kMethod of a @p Target, as sd-bus calls it.
template <class Target, int (*kMethod)(Target&, sd_bus_message*, sd_bus_error*)>
int onMethod(sd_bus_message* message, void* target, sd_bus_error* error) noexcept {
  return guarded(error, [&] { return kMethod(*static_cast<Target*>(target), message, error); });
}

/// The reading of a property of a @p Target, as sd-bus calls it.
template <class Target, int (*kGetter)(Target&, const char* property, sd_bus_message* reply)>
int onProperty(sd_bus* /*bus*/, const char* /*path*/, const char* /*interface*/,
               const char* property, sd_bus_message* reply, void* target,
               sd_bus_error* error) noexcept {
  return guarded(error, [&] { return kGetter(*static_cast<Target*>(target), property, reply); });
}

}  // namespace appliance

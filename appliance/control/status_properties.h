#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "appliance/status/status.h"

/// What a status is on the bus: a table of properties. Pure.
namespace appliance {

/// A value inside a dictionary "a{sv}".
using BusScalar = std::variant<std::uint64_t, std::string>;
using BusDictionary = std::vector<std::pair<std::string, BusScalar>>;

/// Numbers, texts and tables; a table may get more columns without breaking a client.
using BusValue =
    std::variant<std::uint32_t, std::uint64_t, double, std::string, std::vector<std::string>,
                 std::array<double, 3>, std::vector<BusDictionary>>;

struct StatusProperty {
  const char* name;
  const char* type;  ///< D-Bus signature
  BusValue (*value)(const Status&);
  /// What decides whether it changed; the value itself if null. A value without this changes at
  /// every look and is never signalled.
  enum class Signals : bool { kNo, kYes } signals = Signals::kYes;
  BusValue (*essence)(const Status&) = nullptr;
};

/// Everything the interface org.kagami.Kagami1 shows.
[[nodiscard]] std::span<const StatusProperty> statusProperties();

/// The property's signature for a value, as statusProperties() has to name it.
[[nodiscard]] const char* typeOf(const BusValue& value);

/// The names of the properties that PropertiesChanged has to carry.
[[nodiscard]] std::vector<const char*> changedProperties(const Status& before, const Status& now);

}  // namespace appliance

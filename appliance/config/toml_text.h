#pragma once

#include <string>

#include <toml++/toml.h>

#include "appliance/config/toml_reader.h"

/// The words of the TOML reader's messages.
namespace appliance {

/// The shortest form that a person writes: 16384, 0.5, 1e+300.
[[nodiscard]] std::string numberText(double value);

/// "the whole number 3", "text", "an array of 4".
[[nodiscard]] std::string kindOf(const toml::node& node);

/// "from 1 to 16384 px", "at least 0".
[[nodiscard]] std::string rangeText(const NumberRange& range);
[[nodiscard]] std::string rangeText(const IntegerRange& range);

}  // namespace appliance

#pragma once

#include <string>

#include "appliance/tools/report.h"

namespace appliance {

/// report.json: one object; docs/trace.md says what each field is. Distributions without any
/// value have count 0 and null figures.
[[nodiscard]] std::string toJson(const Report& report);

/// The same for people: the bars, and the stages beside the published figures of a laboratory
/// system of the same kind.
[[nodiscard]] std::string toTable(const Report& report);

}  // namespace appliance

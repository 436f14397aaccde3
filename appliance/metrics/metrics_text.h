#pragma once

#include <string>

#include "appliance/metrics/metrics_registry.h"

namespace appliance {

/// One JSON object, a member for each metric by its name: a number, or for durations an object
/// {"count", "p50_us", "p95_us", "longest_us", "longest_ever_us"}.
[[nodiscard]] std::string toJson(const MetricsSnapshot& metrics);

}  // namespace appliance

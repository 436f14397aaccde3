#pragma once

#include <expected>
#include <string>

namespace appliance {

/// The daemon's metrics for people, one a line. @p json: as the control interface's GetMetrics()
/// gives it.
[[nodiscard]] std::expected<std::string, std::string> metricsListing(const std::string& json);

/// The status with the metrics as its member "metrics": what `kagami status --json` prints. The
/// status alone if @p metrics is no JSON object, of an older daemon for instance.
[[nodiscard]] std::string withMetrics(const std::string& status, const std::string& metrics);

}  // namespace appliance

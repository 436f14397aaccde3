#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "appliance/director/command.h"
#include "appliance/status/status.h"

/// What a request of the control interface means in the present state: pure.
/// Errors   One line for the person who asked.
namespace appliance {

/// Nothing to do is an empty optional: a box that is live stays live.
using Requested = std::expected<std::optional<Command>, std::string>;

[[nodiscard]] Requested requestMode(std::string_view mode, const Status& now);
[[nodiscard]] Requested requestDelay(std::uint32_t delay_ms, const Status& now);
/// @p view counts from 1.
[[nodiscard]] Requested requestView(std::uint32_t view, const Status& now);
[[nodiscard]] std::expected<std::array<double, 3>, std::string> requestTarget(double x_m,
                                                                              double y_m,
                                                                              double z_m);

}  // namespace appliance

#pragma once

#include <expected>
#include <string>
#include <vector>

#include <gpiod.hpp>

#include "hal/gpiod/line_finder.h"

namespace hal::gpiod {

inline constexpr const char* kConsumer = "kagamid";

/// Claims @p lines, which are of one chip, with the same settings, in one request.
///
/// Errors  One line that starts with @p key.
[[nodiscard]] std::expected<::gpiod::line_request, std::string> requestLines(
    const std::vector<ListedLine>& lines, const ::gpiod::line_settings& settings,
    const std::string& key);

}  // namespace hal::gpiod

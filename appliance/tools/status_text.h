#pragma once

#include <expected>
#include <string>

namespace appliance {

/// The daemon's status for people. @p json: as the control interface's Status() gives it.
[[nodiscard]] std::expected<std::string, std::string> statusText(const std::string& json);

}  // namespace appliance

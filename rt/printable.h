#pragma once

#include <string>
#include <string_view>

namespace rt {

/// @p foreign as a message may show it, in one line: control characters and bytes that are not
/// UTF-8 become '?', and a text longer than @p longest bytes ends in "...". Terminals obey control
/// characters, and D-Bus refuses texts that are not UTF-8.
///
/// RT  Not RT safe.
[[nodiscard]] std::string printable(std::string_view foreign, std::size_t longest = 1000);

}  // namespace rt

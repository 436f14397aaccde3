#pragma once

#include <cstddef>
#include <string_view>

namespace rt {

/// How many letters must be inserted, removed or replaced to make @p a of @p b: for messages that
/// name what a person may have meant.
///
/// RT  Not RT safe.
[[nodiscard]] std::size_t editDistance(std::string_view a, std::string_view b);

}  // namespace rt

#pragma once

#include <cstddef>
#include <expected>
#include <string>

namespace appliance {

/// More than any file that a person writes. A device or a recording that was named by mistake is
/// larger, and must not fill the memory.
inline constexpr std::size_t kLargestTextFile = std::size_t{4} << 20U;

/// The whole text of a file.
/// Errors   One line: it cannot be opened or read, is a folder or larger than kLargestTextFile.
[[nodiscard]] std::expected<std::string, std::string> readTextFile(const std::string& path);

}  // namespace appliance

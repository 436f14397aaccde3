#pragma once

#include <expected>
#include <filesystem>
#include <string>

namespace appliance {

/// Whether a folder can be made at @p path, looked at before the work that fills it.
/// Errors   One line: something is there already, or the folder around it is not there.
[[nodiscard]] std::expected<void, std::string> checkNewFolder(const std::filesystem::path& path);

/// Copies the folder @p from to @p to, as the caller's own files, and then removes @p from.
/// Errors   One line: what could not be copied. Then @p from stays, and what was copied goes.
/// Returns a line if @p from could not be removed; else it is empty.
[[nodiscard]] std::expected<std::string, std::string> moveFolder(const std::filesystem::path& from,
                                                                 const std::filesystem::path& to);

}  // namespace appliance

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace test {

// Users of every Debian, each in the group of its name. Two of these groups stand in for the
// policy's groups, which the machine of the test need not have.
inline constexpr const char* kViewer = "bin";
inline constexpr const char* kOperator = "sys";
inline constexpr const char* kAnybodyElse = "daemon";

/// The options of a dbus-daemon that is a system bus with the policy file that is installed: for a
/// PrivateBus. Its files and its socket lie in @p folder, which every user may enter afterwards.
/// Other users can be tried by root only.
[[nodiscard]] std::vector<std::string> policedBusOptions(const std::filesystem::path& folder);

}  // namespace test

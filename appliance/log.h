#pragma once

#include <string_view>

namespace appliance {

/// Lines for people, on standard error with syslog levels, which the journal understands.
/// On a terminal the level is a word.
///
/// Threads  main.
/// RT       Not safe.
void logInfo(std::string_view line);
void logWarning(std::string_view line);
void logError(std::string_view line);

}  // namespace appliance

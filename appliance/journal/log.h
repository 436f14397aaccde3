#pragma once

#include <string_view>

namespace appliance {

/// Lines for people, on standard error: with syslog levels where the journal reads them, else
/// with words.
///
/// Threads  main.
/// RT       Not safe.
void logInfo(std::string_view line);
void logWarning(std::string_view line);
void logError(std::string_view line);

}  // namespace appliance

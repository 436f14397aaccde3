#pragma once

#include <string>

namespace CLI {
class App;
}

/// The commands of `kagami`, one function each: it adds its options to @p kagami and a callback
/// that does the work. A callback that cannot do it prints one line and throws CommandFailed.
namespace appliance {

/// Ends the command with this exit status; what is wrong was printed.
struct CommandFailed {
  int status = 1;
};

/// Where the daemon's control interface is looked for.
struct ControlPlace {
  std::string bus = "system";
  std::string name = "org.kagami.Kagami1";
};

/// status, mode, delay, view, target, freeze, sweep, screen. @p place outlives the parsing.
void addControlCommands(CLI::App& kagami, const ControlPlace& place);
/// metrics. @p place outlives the parsing.
void addMetricsCommand(CLI::App& kagami, const ControlPlace& place);
void addConfigCommand(CLI::App& kagami);
void addPlanCommand(CLI::App& kagami);
/// depth. @p place outlives the parsing.
void addDepthCommand(CLI::App& kagami, const ControlPlace& place);
void addReportCommand(CLI::App& kagami);
void addTraceCommand(CLI::App& kagami);

/// Prints "kagami: @p why" and ends the command with exit code 1.
[[noreturn]] void fail(const std::string& why);

}  // namespace appliance

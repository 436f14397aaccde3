#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "appliance/tools/commands.h"
#include "appliance/tools/emulator_files.h"
#include "appliance/tools/report.h"
#include "appliance/tools/report_text.h"

namespace appliance {
namespace {

struct Options {
  std::string trace;
  std::string wire_log;
  std::string emulator_stats;
  std::string out;
  bool table = false;
  double warm_up_s = 2;
};

/// What @p read makes of a file; nothing where none was named.
template <class T>
std::optional<T> readOptional(const std::string& path,
                              std::expected<T, std::string> (*read)(std::istream&,
                                                                    const std::string&)) {
  if (path.empty()) return std::nullopt;
  std::ifstream in(path);
  if (!in) fail(path + ": cannot be read (" + std::strerror(errno) + ")");
  auto content = read(in, path);
  if (!content) fail(content.error());
  return std::move(*content);
}

void report(const Options& options) {
  const auto trace = readTraceFile(options.trace);
  if (!trace) fail(trace.error());
  const auto wire_log = readOptional(options.wire_log, readWireLog);
  const auto emulator = readOptional(options.emulator_stats, readEmulatorStatistics);
  const Report computed = computeReport({.trace = *trace,
                                         .wire_log = wire_log ? &*wire_log : nullptr,
                                         .emulator = emulator ? &*emulator : nullptr,
                                         .warm_up_s = options.warm_up_s});
  if (!options.out.empty()) {
    std::ofstream out(options.out);
    out << toJson(computed);
    out.close();
    if (!out) fail(options.out + ": cannot be written (" + std::strerror(errno) + ")");
  }
  if (options.table)
    std::fputs(toTable(computed).c_str(), stdout);
  else if (options.out.empty())
    std::fputs(toJson(computed).c_str(), stdout);
}

}  // namespace

void addReportCommand(CLI::App& kagami) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = kagami.add_subcommand("report", "Compute the figures of a run");
  command->add_option("--trace", options->trace, "what kagamid wrote ([state] trace)")->required();
  command->add_option("--wire-log", options->wire_log,
                      "what kagami-emulator sent: when a frame's last packet really left");
  command->add_option("--emulator-stats", options->emulator_stats,
                      "whether kagami-emulator kept up");
  command
      ->add_option("--warm-up", options->warm_up_s,
                   "seconds in which lost frames are not held against the bars")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_option("--out", options->out, "write the report here, as JSON");
  command->add_flag("--table", options->table, "print the figures as a table");
  command->callback([options] { report(*options); });
}

}  // namespace appliance

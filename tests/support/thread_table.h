#pragma once

#include <fstream>
#include <map>
#include <regex>
#include <string>

namespace test {

struct TableRow {
  std::string policy;  ///< "fifo" or "other"
  int priority = 0;
};

/// The thread table of docs/real-time.md; families of threads (recv01, recv02 ...) stand under one
/// name.
[[nodiscard]] inline std::map<std::string, TableRow> readThreadTable(const std::string& page) {
  std::map<std::string, TableRow> table;
  std::ifstream file(page);
  const std::regex row(R"(^\| `([a-z0-9]+)`[^|]*\| (FIFO|OTHER) ?(\d*) \|.*)");
  std::smatch found;
  for (std::string line; std::getline(file, line);) {
    if (!std::regex_match(line, found, row)) continue;
    const std::string name = found[1].str().substr(0, found[1].str().find_first_of("0123456789"));
    table[name] = {.policy = found[2] == "FIFO" ? "fifo" : "other",
                   .priority = found[3].length() > 0 ? std::stoi(found[3]) : 0};
  }
  return table;
}

/// The table's name of a task: recv01, recv02, ... are one row; a task that a library made, and
/// main itself, bear the program's name or the library's.
[[nodiscard]] inline std::string tableName(const std::string& task) {
  for (const char* family : {"recv", "watch", "draw", "probe"}) {
    if (task.starts_with(family)) return family;
  }
  for (const char* library : {"kagamid", "gmain", "gdbus", "arv_gv_heartbea"}) {
    if (task.starts_with(library)) return "main";  // SCHED_OTHER, as main, which made it
  }
  return task;
}

}  // namespace test

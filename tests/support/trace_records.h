#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace test {

/// The records of a trace by their kind, in the order of the file. A last line that is not whole
/// yet is left out: the daemon may still be writing.
[[nodiscard]] inline std::map<std::string, std::vector<nlohmann::json>> readTrace(
    const std::filesystem::path& path) {
  std::map<std::string, std::vector<nlohmann::json>> records;
  std::ifstream trace(path);
  for (std::string line; std::getline(trace, line) && !trace.eof();) {
    nlohmann::json record = nlohmann::json::parse(line);
    records[record["record"]].push_back(std::move(record));
  }
  return records;
}

}  // namespace test

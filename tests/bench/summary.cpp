/// bench_summary ROWS [JSON]: the comparisons of all benchmarks as one table, and as one JSON file.
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/bench/support/row.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: bench_summary ROWS [JSON]\n", stderr);
    return 2;
  }
  std::ifstream file(argv[1]);
  std::vector<nlohmann::json> rows;
  for (std::string line; std::getline(file, line);) {
    rows.push_back(nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false));
    if (!rows.back().is_object()) {
      std::fprintf(stderr, "%s: line %zu is no comparison\n", argv[1], rows.size());
      return 1;
    }
  }
  bench::printTable(rows);
  if (argc < 3) return 0;
  std::ofstream json(argv[2]);
  json << nlohmann::json{{"cpus", std::thread::hardware_concurrency()}, {"comparisons", rows}}.dump(
              2)
       << '\n';
  json.flush();
  if (!json) std::fprintf(stderr, "%s: cannot be written\n", argv[2]);
  return json ? 0 : 1;
}

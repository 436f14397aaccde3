#include "tests/bench/support/row.h"

#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

namespace bench {

void printTable(const std::vector<nlohmann::json>& rows) {
  const auto number = [](const nlohmann::json& row, const char* key, const char* format) {
    if (!row.contains(key)) return std::string("-");
    char text[32];
    std::snprintf(text, sizeof text, format, row[key].get<double>());
    return std::string(text);
  };
  std::printf("%-48s %9s %9s %-12s %6s  %-20s %s\n", "what", "ours", "rival", "unit", "ratio",
              "bar", "verdict");
  for (const auto& row : rows) {
    const auto name = row[kBenchmark].get<std::string>() + ": " + row[kWhat].get<std::string>();
    std::printf("%-48s %9s %9s %-12s %6s  %-20s %s\n", name.c_str(),
                number(row, kOursFigure, "%.4g").c_str(), number(row, kRivalFigure, "%.4g").c_str(),
                row[kUnit].get<std::string>().c_str(), number(row, kRatio, "%.2f").c_str(),
                row[kBar].get<std::string>().c_str(), row[kVerdict].get<std::string>().c_str());
  }
}

}  // namespace bench

#include "tests/bench/support/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/bench/support/row.h"

namespace bench {
namespace {

constexpr std::size_t kMostValuesKept = 100;  // of a contestant, in the JSON line

double rank(const std::vector<double>& sorted, double share) {
  const auto at = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(at, 1, sorted.size()) - 1];
}

double pick(const Figures& figures, Statistic statistic) {
  return statistic == Statistic::kMedian ? figures.median : figures.p99;
}

std::string shown(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

nlohmann::json toJson(const Samples& samples) {
  const Figures figures = figuresOf(samples.values);
  nlohmann::json json{{"name", samples.name},
                      {"count", samples.values.size()},
                      {"median", figures.median},
                      {"p99", figures.p99},
                      {"max", figures.max}};
  if (samples.values.size() <= kMostValuesKept) json["values"] = samples.values;
  return json;
}

std::string textOf(const std::optional<Bar>& bar, const std::string& unit) {
  if (!bar) return "-";
  switch (bar->kind) {
    case Bar::Kind::kRatioAtMost:
      return shown("<= %.2f", bar->value);
    case Bar::Kind::kRatioAtLeast:
      return shown(">= %.2f", bar->value);
    case Bar::Kind::kOursAtMost:
      return "ours " + shown("<= %.3g ", bar->value) + unit;
    case Bar::Kind::kOursAtLeast:
      return "ours " + shown(">= %.3g ", bar->value) + unit;
  }
  return "-";
}

bool holds(const Bar& bar, double ours, double ratio) {
  switch (bar.kind) {
    case Bar::Kind::kRatioAtMost:
      return ratio <= bar.value;
    case Bar::Kind::kRatioAtLeast:
      return ratio >= bar.value;
    case Bar::Kind::kOursAtMost:
      return ours <= bar.value;
    case Bar::Kind::kOursAtLeast:
      return ours >= bar.value;
  }
  return false;
}

std::string verdictOf(const Comparison& c, double ours, double ratio) {
  if (!c.not_judged.empty()) return c.not_judged;
  if (c.ours.values.empty()) return "not measured";
  if (!c.bar) return "-";
  const bool needs_rival =
      c.bar->kind == Bar::Kind::kRatioAtMost || c.bar->kind == Bar::Kind::kRatioAtLeast;
  if (needs_rival && c.rival.values.empty()) return "no rival";
  return holds(*c.bar, ours, ratio) ? "PASS" : "FAIL";
}

void print(const Samples& samples, const std::string& unit) {
  if (samples.values.empty()) return;
  const Figures figures = figuresOf(samples.values);
  std::printf("    %-30s %10.4g %10.4g %10.4g  %s of %zu\n", samples.name.c_str(), figures.median,
              figures.p99, figures.max, unit.c_str(), samples.values.size());
}

}  // namespace

Figures figuresOf(const std::vector<double>& values) {
  if (values.empty()) return {};
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  return {rank(sorted, 0.5), rank(sorted, 0.99), sorted.back()};
}

Options takeOptions(std::vector<std::string>& arguments) {
  Options options;
  for (auto at = arguments.begin(); at != arguments.end();) {
    if (*at == "--quick") {
      options.quick = true;
      at = arguments.erase(at);
    } else if (*at == "--rows" && at + 1 != arguments.end()) {
      options.rows = *(at + 1);
      at = arguments.erase(at, at + 2);
    } else {
      ++at;
    }
  }
  return options;
}

bool report(const std::string& benchmark, const std::vector<Comparison>& comparisons,
            const Options& options) {
  std::vector<nlohmann::json> rows;
  std::printf("    %-30s %10s %10s %10s\n", benchmark.c_str(), "median", "p99", "max");
  for (const Comparison& c : comparisons) {
    const double ours = pick(figuresOf(c.ours.values), c.statistic);
    const double rival = pick(figuresOf(c.rival.values), c.statistic);
    const bool both = ours > 0 && rival > 0;
    const double ratio = !both ? 0 : c.as_speed ? rival / ours : ours / rival;
    nlohmann::json row{{kBenchmark, benchmark},
                       {kWhat, c.what},
                       {kUnit, c.unit},
                       {"statistic", c.statistic == Statistic::kMedian ? "median" : "p99"},
                       {kOurs, toJson(c.ours)},
                       {kBar, textOf(c.bar, c.unit)},
                       {kVerdict, verdictOf(c, ours, ratio)}};
    if (!c.ours.values.empty()) row[kOursFigure] = ours;
    if (!c.rival.values.empty()) {
      row[kRival] = toJson(c.rival);
      row[kRivalFigure] = rival;
    }
    if (both) row[kRatio] = ratio;
    std::printf("  %s\n", c.what.c_str());
    print(c.ours, c.unit);
    print(c.rival, c.unit);
    rows.push_back(std::move(row));
  }
  printTable(rows);
  std::fflush(stdout);
  if (options.rows.empty()) return true;
  std::ofstream file(options.rows, std::ios::app);
  for (const auto& row : rows) file << row << '\n';
  file.flush();
  if (!file) std::fprintf(stderr, "%s: cannot be written\n", options.rows.c_str());
  return static_cast<bool>(file);
}

}  // namespace bench

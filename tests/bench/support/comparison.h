#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bench {

/// What one contestant needed, round by round; less is better. Unit as the comparison says.
struct Samples {
  std::string name;
  std::vector<double> values;
};

struct Figures {
  double median = 0;
  double p99 = 0;
  double max = 0;
};

/// Nearest rank; all zero without values.
[[nodiscard]] Figures figuresOf(const std::vector<double>& values);

enum class Statistic { kMedian, kP99 };

/// What is promised of a comparison.
struct Bar {
  enum class Kind {
    kRatioAtMost,
    kRatioAtLeast,
    kOursAtMost,  ///< ours alone, in its unit
    kOursAtLeast,
  };
  Kind kind = Kind::kRatioAtMost;
  double value = 0;
};

/// Ours beside a rival's, measured in the same run.
struct Comparison {
  std::string what;
  std::string unit;
  Samples ours;
  Samples rival = {};     ///< no values: nothing to compare with
  bool as_speed = false;  ///< the ratio shown is rival's / ours, else ours / rival's
  Statistic statistic = Statistic::kMedian;
  std::optional<Bar> bar = std::nullopt;
  std::string not_judged = {};  ///< why the bar says nothing here; empty: it does
};

/// Every bench program takes these.
struct Options {
  std::filesystem::path rows;  ///< one JSON line per comparison is added there; empty: nowhere
  bool quick = false;          ///< shows that it works; its figures are worth nothing
};

/// Takes --rows FILE and --quick out of the command line.
[[nodiscard]] Options takeOptions(std::vector<std::string>& arguments);

/// Prints every contestant's median, p99 and maximum and each comparison's ratio and verdict, and
/// adds the lines to options.rows. False where that file cannot be written.
[[nodiscard]] bool report(const std::string& benchmark, const std::vector<Comparison>& comparisons,
                          const Options& options);

}  // namespace bench

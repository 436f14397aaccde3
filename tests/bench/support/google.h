#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/bench/support/comparison.h"

namespace bench {

/// What each of a program's Google benchmarks needed per iteration, in nanoseconds of real time,
/// one value per repetition; counters beside them as "NAME:COUNTER", in their own unit. A name is
/// the function's, then its arguments: "remap/1280/720".
class Repetitions {
 public:
  void add(const std::string& name, double value) { values_[name].push_back(value); }

  /// Of benchmark @p name, called @p as in the table, in units of @p unit_ns nanoseconds.
  [[nodiscard]] Samples samples(const std::string& name, const std::string& as,
                                double unit_ns = 1) const;

 private:
  std::map<std::string, std::vector<double>> values_;
};

/// Runs the registered benchmarks in interleaved repetitions, so that a busy moment of the machine
/// hits all of them. What the command line does not know goes to Google Benchmark.
/// Errors  false: the arguments are wrong; a line was printed.
[[nodiscard]] bool runGoogleBenchmarks(std::vector<std::string> arguments, const Options& options,
                                       Repetitions& results);

}  // namespace bench

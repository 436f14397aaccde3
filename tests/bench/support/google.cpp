#include "tests/bench/support/google.h"

#include <benchmark/benchmark.h>

namespace bench {
namespace {

class Collector final : public benchmark::BenchmarkReporter {
 public:
  explicit Collector(Repetitions& results) : results_(results) {}

  bool ReportContext(const Context& /*context*/) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.iterations == 0) continue;
      const auto& id = run.run_name;
      const std::string name =
          id.args.empty() ? id.function_name : id.function_name + "/" + id.args;
      results_.add(name, run.real_accumulated_time * 1e9 / static_cast<double>(run.iterations));
      for (const auto& [counter, value] : run.counters) results_.add(name + ":" + counter, value);
    }
  }

 private:
  Repetitions& results_;
};

}  // namespace

Samples Repetitions::samples(const std::string& name, const std::string& as, double unit_ns) const {
  Samples samples{as, {}};
  const auto found = values_.find(name);
  if (found == values_.end()) return samples;
  for (const double value : found->second) samples.values.push_back(value / unit_ns);
  return samples;
}

bool runGoogleBenchmarks(std::vector<std::string> arguments, const Options& options,
                         Repetitions& results) {
  std::vector<std::string> all{arguments.empty() ? "bench" : arguments.front(),
                               "--benchmark_enable_random_interleaving=true"};
  all.emplace_back(options.quick ? "--benchmark_repetitions=2" : "--benchmark_repetitions=25");
  all.emplace_back(options.quick ? "--benchmark_min_time=0.001" : "--benchmark_min_time=0.04");
  if (!arguments.empty()) all.insert(all.end(), arguments.begin() + 1, arguments.end());
  std::vector<char*> argv;
  for (std::string& argument : all) argv.push_back(argument.data());
  int argc = static_cast<int>(argv.size());
  benchmark::Initialize(&argc, argv.data());
  if (benchmark::ReportUnrecognizedArguments(argc, argv.data())) return false;
  Collector collector(results);
  benchmark::RunSpecifiedBenchmarks(&collector);
  return true;
}

}  // namespace bench

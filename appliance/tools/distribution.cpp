#include "appliance/tools/distribution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace appliance {
namespace {

/// The smallest value that @p share of all do not exceed.
double nearestRank(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace

Distribution distributionOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {.count = values.size(),
          .mean = mean,
          .sd = values.size() > 1 ? std::sqrt(squares / (count - 1)) : 0,
          .p50 = nearestRank(values, 0.5),
          .p99 = nearestRank(values, 0.99),
          .p999 = nearestRank(values, 0.999),
          .max = values.back()};
}

}  // namespace appliance

#include "rt/statistics.h"

#include <cmath>
#include <vector>

namespace rt {
namespace {

/// How many of @p count values a percentile must cover: at least one.
std::uint64_t rankOf(std::uint64_t per_mille, std::uint64_t count) {
  return std::max<std::uint64_t>((count * per_mille + 999) / 1000, 1);
}

}  // namespace

Distribution distributionOf(std::span<const double> values) {
  if (values.empty()) return {};
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const auto percentile = [&sorted](std::uint64_t per_mille) {
    return sorted[rankOf(per_mille, sorted.size()) - 1];
  };

  const auto count = static_cast<double>(sorted.size());
  double sum = 0;
  for (const double value : sorted) sum += value;
  const double mean = sum / count;
  double squares = 0;
  for (const double value : sorted) squares += (value - mean) * (value - mean);
  return {.count = sorted.size(),
          .mean = mean,
          .sd = std::sqrt(squares / count),
          .p50 = percentile(500),
          .p99 = percentile(990),
          .p999 = percentile(999),
          .max = sorted.back()};
}

Distribution scaled(const Distribution& distribution, double factor) noexcept {
  return {.count = distribution.count,
          .mean = distribution.mean * factor,
          .sd = distribution.sd * factor,
          .p50 = distribution.p50 * factor,
          .p99 = distribution.p99 * factor,
          .p999 = distribution.p999 * factor,
          .max = distribution.max * factor};
}

double CycleStatistics::middleOf(std::size_t bucket) noexcept {
  if (bucket < 2 * kSubBuckets) return static_cast<double>(bucket);
  const auto shift = static_cast<int>(bucket / kSubBuckets) - 1;
  const auto lowest = static_cast<double>(bucket % kSubBuckets + kSubBuckets);
  // The integers [lowest, lowest + 1) * 2^shift: their mean is half a step short of the middle.
  return std::ldexp(lowest + 0.5, shift) - 0.5;
}

Distribution CycleStatistics::distributionNs() const noexcept {
  std::array<std::uint64_t, kBuckets> counts{};
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    counts[i] = buckets_[i].load(std::memory_order_relaxed);
    count += counts[i];
  }
  if (count == 0) return {};
  const auto max_ns = static_cast<double>(max_ns_.load(std::memory_order_relaxed));
  const auto percentile = [&](std::uint64_t per_mille) {
    std::uint64_t left = rankOf(per_mille, count);
    std::size_t bucket = 0;
    while (bucket + 1 < kBuckets && counts[bucket] < left) left -= counts[bucket++];
    return bucket + 1 == kBuckets ? max_ns : std::min(middleOf(bucket), max_ns);
  };
  const double squares = squares_ns2_.load(std::memory_order_relaxed);
  return {.count = count,
          .mean = mean_ns_.load(std::memory_order_relaxed),
          .sd = std::sqrt(squares / static_cast<double>(count)),
          .p50 = percentile(500),
          .p99 = percentile(990),
          .p999 = percentile(999),
          .max = max_ns};
}

}  // namespace rt

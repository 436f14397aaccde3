#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace rt {

/// A distribution in few numbers. The unit is that of the values it came from.
///
/// Percentiles are nearest-rank: the smallest value that at least that share of
/// all values does not exceed, so always a value that occurred. The standard
/// deviation is the population's (divided by count). All zero when count is 0.
struct Distribution {
  std::uint64_t count = 0;
  double mean = 0;
  double sd = 0;
  double p50 = 0;
  double p99 = 0;
  double p999 = 0;
  double max = 0;
};

/// Exact, for reports made after the run.
/// RT  Not safe: sorts a copy.
[[nodiscard]] Distribution distributionOf(std::span<const double> values);

/// The same distribution in another unit: ns to ms with @p factor 1e-6.
[[nodiscard]] Distribution scaled(const Distribution& distribution, double factor) noexcept;

/// Durations of one loop's cycles (a wake latency, a stage), counted while it runs.
///
/// A log-linear histogram: every power of two is divided into 64 equal buckets, so a
/// percentile is off by less than 1 %; mean, sd and max are exact. Durations from
/// 18 min on share the last bucket, negative ones count as zero.
///
/// Threads  record(): the loop's thread. distributionNs(): any; while record() runs it
///          may miss the newest duration or parts of it.
/// RT       record() is wait-free. distributionNs() is not for real-time threads.
/// Memory   About 18 KiB inside the object; one writer, so no read-modify-write.
class CycleStatistics {
 public:
  void record(Nanoseconds duration) RT_SAFE {
    const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(duration.count(), 0));
    add(buckets_[bucketOf(ns)], std::uint64_t{1});
    const auto count = count_.load(std::memory_order_relaxed) + 1;
    // Welford's update: no cancellation, however long it runs.
    const double mean = mean_ns_.load(std::memory_order_relaxed);
    const double delta = static_cast<double>(ns) - mean;
    const double new_mean = mean + delta / static_cast<double>(count);
    mean_ns_.store(new_mean, std::memory_order_relaxed);
    add(squares_ns2_, delta * (static_cast<double>(ns) - new_mean));
    if (ns > max_ns_.load(std::memory_order_relaxed)) {
      max_ns_.store(ns, std::memory_order_relaxed);
    }
    count_.store(count, std::memory_order_relaxed);
  }

  [[nodiscard]] Distribution distributionNs() const noexcept;

 private:
  static constexpr unsigned kSubBits = 6;
  static constexpr std::uint64_t kSubBuckets = std::uint64_t{1} << kSubBits;
  static constexpr unsigned kValueBits = 40;  // 2^40 ns = 18 min
  static constexpr std::size_t kBuckets = (kValueBits - kSubBits + 1) * kSubBuckets;

  /// Exact up to 127, then the 7 leading bits and where they stand.
  static constexpr std::size_t bucketOf(std::uint64_t ns) noexcept {
    if (ns < kSubBuckets) return ns;
    const auto shift = static_cast<unsigned>(std::bit_width(ns)) - (kSubBits + 1);
    return std::min<std::uint64_t>(shift * kSubBuckets + (ns >> shift), kBuckets - 1);
  }
  /// The middle of the durations that @p bucket counts.
  static double middleOf(std::size_t bucket) noexcept;

  template <typename T>
  static void add(std::atomic<T>& to, T amount) noexcept {
    to.store(to.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
  }

  std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<double> mean_ns_{0};
  std::atomic<double> squares_ns2_{0};  // sum of squared deviations from the mean
  std::atomic<std::uint64_t> max_ns_{0};
};

}  // namespace rt

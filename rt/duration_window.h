#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace rt {

/// What a DurationWindow holds. Quantiles are by nearest rank; without durations all is zero.
struct DurationSummary {
  std::uint64_t count = 0;  ///< since the beginning
  Nanoseconds p50{0};       ///< of the last durations, as the next two
  Nanoseconds p95{0};
  Nanoseconds longest{0};
  Nanoseconds longest_ever{0};

  friend bool operator==(const DurationSummary&, const DurationSummary&) = default;
};

/// How long something takes that one thread does again and again: the last 256 durations, for
/// any reader. A reader may see a few durations of the next round among those of the last one.
///
/// Threads  add(): one thread. summary(): any.
/// RT       add() is wait-free. summary() sorts 256 numbers: for the reader's own time.
class DurationWindow {
 public:
  static constexpr std::size_t kKept = 256;

  void add(Nanoseconds duration) RT_SAFE {
    const std::uint64_t count = count_.load(std::memory_order_relaxed);
    durations_ns_[count % kKept].store(duration.count(), std::memory_order_relaxed);
    if (duration.count() > longest_ns_.load(std::memory_order_relaxed)) {
      longest_ns_.store(duration.count(), std::memory_order_relaxed);
    }
    count_.store(count + 1, std::memory_order_release);
  }

  [[nodiscard]] DurationSummary summary() const noexcept {
    DurationSummary summary{.count = count_.load(std::memory_order_acquire)};
    const auto kept = static_cast<std::size_t>(std::min<std::uint64_t>(summary.count, kKept));
    if (kept == 0) return summary;
    std::array<std::int64_t, kKept> sorted{};
    for (std::size_t i = 0; i < kept; ++i) {
      sorted[i] = durations_ns_[i].load(std::memory_order_relaxed);
    }
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(kept));
    const auto rank = [&](std::size_t per_cent) {
      return Nanoseconds(sorted[(kept * per_cent + 99) / 100 - 1]);
    };
    summary.p50 = rank(50);
    summary.p95 = rank(95);
    summary.longest = Nanoseconds(sorted[kept - 1]);
    summary.longest_ever = Nanoseconds(longest_ns_.load(std::memory_order_relaxed));
    return summary;
  }

 private:
  std::array<std::atomic<std::int64_t>, kKept> durations_ns_{};
  std::atomic<std::int64_t> longest_ns_{0};
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace rt

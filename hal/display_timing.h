#pragma once

#include <cmath>
#include <cstdint>

#include "rt/annotations.h"
#include "rt/clock.h"

namespace hal {

/// What is known of a screen's vblanks, and of what a picture costs: enough to predict page flips.
/// Trivially copyable.
///
/// RT       Every member is RT safe: arithmetic.
struct DisplayTiming {
  std::uint64_t vblank = 0;    ///< a recent vblank's number
  rt::Timestamp at;            ///< its instant: the estimate from many stamps, not its own stamp
  double period_ns = 0;        ///< above 0
  double stamp_jitter_ns = 0;  ///< rms of the stamps about the estimate
  rt::Nanoseconds draw{};      ///< from warp_submit to warp_end, nearly always
  rt::Nanoseconds commit_margin{};  ///< a commit nearer to a vblank than this may miss it

  [[nodiscard]] rt::Timestamp vblankAt(std::uint64_t number) const RT_SAFE {
    const auto since = static_cast<std::int64_t>(number - vblank);
    return at + rt::Nanoseconds(std::llround(static_cast<double>(since) * period_ns));
  }

  /// The first vblank strictly after @p t, which lies less than 2^62 ns from `at`.
  [[nodiscard]] std::uint64_t firstVblankAfter(rt::Timestamp t) const RT_SAFE {
    const auto since_ns = static_cast<double>((t - at).count());
    std::uint64_t number =
        vblank + static_cast<std::uint64_t>(std::llround(std::floor(since_ns / period_ns)));
    while (vblankAt(number) <= t) ++number;  // the division may fall on either side of a vblank
    return number;
  }

  /// The last instant at which the warp of a picture for that vblank may begin.
  [[nodiscard]] rt::Timestamp latestStart(std::uint64_t number) const RT_SAFE {
    return vblankAt(number) - draw - commit_margin;
  }
};

}  // namespace hal

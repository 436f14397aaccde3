#pragma once

#include <cstdint>
#include <optional>

#include "rt/clock.h"

namespace hal::openni {

/// How a recording is played.
enum class Play : std::uint8_t {
  kRealTime,    ///< pictures come as far apart as they were taken
  kEveryFrame,  ///< the next one as soon as it is asked for
};

/// When the pictures of a recording are due: as far apart as they were taken, beginning with the
/// first one that is asked for. Pure.
class PlayClock {
 public:
  /// The picture's exposure on our clock, and the instant from which on it may be shown.
  [[nodiscard]] rt::Timestamp due(std::uint64_t stamp_us, rt::Timestamp now) {
    // A recording of several runs may jump either way: it goes on with the next picture.
    const bool jumped = stamp_us < last_stamp_us_ || stamp_us - last_stamp_us_ > kLongest_us;
    if (!started_ || jumped) {
      origin_ = now;
      first_stamp_us_ = stamp_us;
      started_ = true;
    }
    last_stamp_us_ = stamp_us;
    return origin_ + rt::Nanoseconds(static_cast<std::int64_t>(stamp_us - first_stamp_us_) * 1000);
  }

 private:
  static constexpr std::uint64_t kLongest_us = 10'000'000;

  bool started_ = false;
  rt::Timestamp origin_;
  std::uint64_t first_stamp_us_ = 0;
  std::uint64_t last_stamp_us_ = 0;
};

}  // namespace hal::openni

#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "rt/clock.h"

namespace hal::openni {

/// How long to wait from one worker's end to the next one's start. Each failure doubles the
/// pause, so that a driver that crashes while it loads does not keep the machine busy. A sensor
/// that was only unplugged is no failure. Pure.
class RestartPause {
 public:
  static constexpr rt::Nanoseconds kShortest = std::chrono::milliseconds(200);
  static constexpr rt::Nanoseconds kLongest = std::chrono::seconds(30);
  /// A worker that delivered pictures for so long has proven itself.
  static constexpr rt::Nanoseconds kProven = std::chrono::seconds(10);

  enum class End : std::uint8_t {
    kFailure,    ///< it crashed, hung, gave up or did not start
    kUnplugged,  ///< its sensor went; the next worker waits for it
  };

  void onPicture(rt::Timestamp at) {
    if (!first_) first_ = at;
    last_ = at;
  }

  /// The worker ended: the pause before the next one.
  [[nodiscard]] rt::Nanoseconds next(End end) {
    if (first_ && last_ - *first_ >= kProven) pause_ = kShortest;
    first_.reset();
    const rt::Nanoseconds pause = pause_;
    if (end == End::kFailure) pause_ = std::min(2 * pause_, kLongest);
    return pause;
  }

 private:
  rt::Nanoseconds pause_ = kShortest;
  std::optional<rt::Timestamp> first_;  // picture of the running worker
  rt::Timestamp last_;
};

}  // namespace hal::openni

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/depth_sensor.h"
#include "rt/clock.h"

namespace appliance {

/// How punctually the pictures of a depth sensor came, from the first one on. Pure.
class DepthRecord {
 public:
  void onFrame(const hal::DepthFrame& frame);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  /// Numbers that never came, without those of outages.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] std::uint64_t withoutColour() const { return without_colour_; }
  /// Pauses of more than kOutage: the sensor was gone that long.
  [[nodiscard]] const std::vector<rt::Nanoseconds>& outages() const { return outages_; }
  /// Of the sensor, by the arrivals between outages; 0: too few pictures.
  [[nodiscard]] double rate_hz() const;
  /// From the first picture to the last.
  [[nodiscard]] rt::Nanoseconds length() const { return length_; }
  [[nodiscard]] rt::Nanoseconds longestInterval() const { return longest_; }

  /// Pauses longer than this are outages, not lost pictures.
  static constexpr rt::Nanoseconds kOutage{500'000'000};

 private:
  std::uint64_t frames_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t without_colour_ = 0;
  std::vector<rt::Nanoseconds> outages_;
  rt::Nanoseconds length_{};
  rt::Nanoseconds streamed_{};   // length_ less outages
  std::uint64_t intervals_ = 0;  // in streamed_, lost pictures among them
  rt::Nanoseconds longest_{};
  std::uint64_t last_number_ = 0;
  rt::Timestamp last_ready_;
};

/// What `kagami depth watch` prints: one line a figure.
[[nodiscard]] std::string recordText(const DepthRecord& record);

}  // namespace appliance

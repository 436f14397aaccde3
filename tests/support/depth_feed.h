#pragma once

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/emulated/openni/practice_room.h"
#include "hal/emulated/openni/ring.h"

namespace test {

/// What an emulated depth sensor sees while a test runs: the practice room at 30 Hz. Plugged in
/// with the object, and out with its end.
class DepthFeed {
 public:
  static emulator::RgbdFormat sized(std::uint32_t width_px, std::uint32_t height_px) {
    return {.width_px = width_px,
            .height_px = height_px,
            .focal_px = 570.0 * width_px / 640,
            .centre_x_px = 0.5 * (width_px - 1),
            .centre_y_px = 0.5 * (height_px - 1)};
  }
  static emulator::RgbdFormat small() { return sized(320, 240); }

  explicit DepthFeed(const emulator::RgbdFormat& format = small()) : room_(format) {
    path_ = std::filesystem::path("/dev/shm") / ("kagami-depth-test-" + std::to_string(::getpid()));
    ::setenv("KAGAMI_DEPTH_RING", path_.c_str(), 1);
    auto ring = emulator::DepthRingWriter::create(path_, format);
    if (!ring) {
      ADD_FAILURE() << ring.error();
      return;
    }
    ring_.emplace(std::move(*ring));
    thread_ = std::jthread([this](const std::stop_token& stop) { feed(stop); });
  }
  DepthFeed(const DepthFeed&) = delete;
  DepthFeed& operator=(const DepthFeed&) = delete;
  ~DepthFeed() {
    thread_ = {};
    ring_.reset();
  }

  void plug(bool in) { ring_->setPlugged(in); }
  void pause(bool paused) { paused_.store(paused); }

  /// The truth about a picture; the epoch if there was none of that number.
  [[nodiscard]] rt::Timestamp exposureOf(std::uint64_t number) const {
    const std::scoped_lock lock(mutex_);
    const auto found = exposures_.find(number);
    return found == exposures_.end() ? rt::Timestamp{} : found->second;
  }

 private:
  void feed(const std::stop_token& stop) {
    const rt::Nanoseconds period(33'333'333);
    const rt::Timestamp start = rt::now();
    for (std::int64_t i = 0; !stop.stop_requested(); ++i) {
      const rt::Timestamp exposure = start + i * period;
      std::this_thread::sleep_until(exposure - period);
      if (paused_.load()) continue;
      room_.draw(static_cast<double>(i) / 30, false, ring_->begin());
      const std::scoped_lock lock(mutex_);
      exposures_[ring_->publish(exposure)] = exposure;
    }
  }

  emulator::PracticeRoom room_;
  std::filesystem::path path_;
  std::optional<emulator::DepthRingWriter> ring_;
  std::atomic<bool> paused_{false};
  mutable std::mutex mutex_;
  std::map<std::uint64_t, rt::Timestamp> exposures_;
  std::jthread thread_;
};

}  // namespace test

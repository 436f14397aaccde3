#include "appliance/depth/depth_loop.h"

#include <chrono>

namespace appliance {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kPatience = 100ms;
constexpr rt::Nanoseconds kRateOver = 2s;

}  // namespace

void DepthLoop::run(const std::stop_token& stop) {
  rt::Timestamp since = rt::now();
  std::uint64_t pictures = 0;
  while (!stop.stop_requested()) {
    if (const auto frame = sensor_->waitFrame(kPatience)) {
      board_.publish(*frame);  // the one copy: the sensor lends its picture until the next call
      newest_exposure_ns_.store(rt::toNs(frame->exposure), std::memory_order_relaxed);
      ++pictures;
    }
    const rt::Nanoseconds over = rt::now() - since;
    if (over < kRateOver) continue;
    rate_hz_.store(static_cast<double>(pictures) / std::chrono::duration<double>(over).count(),
                   std::memory_order_relaxed);
    since += over;
    pictures = 0;
  }
}

DepthReport DepthLoop::report() const {
  DepthReport report{.sensor = sensor_->status(),
                     .rate_hz = rate_hz_.load(std::memory_order_relaxed),
                     .readers = board_.readers()};
  const rt::Timestamp newest = rt::fromNs(newest_exposure_ns_.load(std::memory_order_relaxed));
  if (newest != rt::Timestamp{}) report.age = rt::now() - newest;
  return report;
}

}  // namespace appliance

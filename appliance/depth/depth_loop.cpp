#include "appliance/depth/depth_loop.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <string_view>

namespace appliance {
namespace {

using namespace std::chrono_literals;

constexpr rt::Nanoseconds kPatience = 100ms;
constexpr rt::Nanoseconds kRateOver = 2s;

constexpr std::array<std::string_view, 4> kStates = {"connecting", "streaming", "lost", "ended"};

}  // namespace

std::string depthText(const DepthReport& report) {
  const hal::DepthStatus& sensor = report.sensor;
  std::string text(kStates[static_cast<std::size_t>(sensor.state)]);
  if (!sensor.name.empty()) text += ": " + sensor.name;
  if (sensor.frames == 0) return text;
  std::array<char, 200> numbers{};
  (void)std::snprintf(numbers.data(), numbers.size(),
                      ", %ux%u %s, %.1f Hz; %llu pictures, %llu lost", sensor.width_px,
                      sensor.height_px, sensor.colour ? "with colour" : "without colour",
                      report.rate_hz, static_cast<unsigned long long>(sensor.frames),
                      static_cast<unsigned long long>(sensor.lost));
  text += numbers.data();
  if (sensor.without_colour > 0)
    text += ", " + std::to_string(sensor.without_colour) + " without their colour";
  if (sensor.returns > 0) text += "; came back " + std::to_string(sensor.returns) + " times";
  return text;
}

std::string depthTrouble(const DepthReport& report) {
  const hal::DepthStatus& sensor = report.sensor;
  if (!sensor.message.empty()) return sensor.message;
  if (sensor.state == hal::DepthState::kEnded)
    return "depth sensor: the recording is over: set depth_sensor.repeat to play it again";
  return {};
}

void DepthLoop::run(const std::stop_token& stop) {
  rt::Timestamp since = rt::now();
  std::uint64_t pictures = 0;
  while (!stop.stop_requested()) {
    if (sensor_->waitFrame(kPatience)) ++pictures;
    const rt::Nanoseconds over = rt::now() - since;
    if (over < kRateOver) continue;
    rate_hz_.store(static_cast<double>(pictures) / std::chrono::duration<double>(over).count(),
                   std::memory_order_relaxed);
    since += over;
    pictures = 0;
  }
}

DepthReport DepthLoop::report() const {
  return {sensor_->status(), rate_hz_.load(std::memory_order_relaxed)};
}

}  // namespace appliance

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

std::string readerText(const DepthReaderStatus& reader) {
  if (reader.taken + reader.refused == 0) return {};
  std::string text = "; reader " + reader.name + " took " + std::to_string(reader.taken) +
                     " and lost " + std::to_string(reader.lost);
  if (reader.refused > 0) {
    text += ", refused " + std::to_string(reader.refused) + " times because it kept " +
            std::to_string(reader.pins) + " pictures";
  }
  return text;
}

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
  if (report.age && sensor.state != hal::DepthState::kStreaming) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(*report.age);
    text += "; the last picture was taken " + std::to_string(seconds.count()) + " s ago";
  }
  for (const DepthReaderStatus& reader : report.readers) text += readerText(reader);
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

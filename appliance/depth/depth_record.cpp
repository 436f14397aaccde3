#include "appliance/depth/depth_record.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

namespace appliance {
namespace {

double inSeconds(rt::Nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

void DepthRecord::onFrame(const hal::DepthFrame& frame) {
  ++frames_;
  if (frame.colour_rgb.empty()) ++without_colour_;
  if (frames_ > 1) {
    const rt::Nanoseconds pause = frame.frame_ready - last_ready_;
    length_ += pause;
    if (pause > kOutage) {
      outages_.push_back(pause);
    } else {
      longest_ = std::max(longest_, pause);
      streamed_ += pause;
      const std::uint64_t step = frame.number > last_number_ ? frame.number - last_number_ : 1;
      intervals_ += step;
      lost_ += step - 1;
    }
  }
  last_number_ = frame.number;
  last_ready_ = frame.frame_ready;
}

double DepthRecord::rate_hz() const {
  return streamed_.count() > 0 ? static_cast<double>(intervals_) / inSeconds(streamed_) : 0;
}

std::string recordText(const DepthRecord& record) {
  rt::Nanoseconds gone{};
  for (const rt::Nanoseconds outage : record.outages()) gone = std::max(gone, outage);
  std::array<char, 400> text{};
  (void)std::snprintf(text.data(), text.size(),
                      "pictures   %llu in %.1f s, %.3f a second\n"
                      "lost       %llu\n"
                      "no colour  %llu\n"
                      "interval   %.1f ms at most\n"
                      "outages    %zu, the longest %.2f s\n",
                      static_cast<unsigned long long>(record.frames()), inSeconds(record.length()),
                      record.rate_hz(), static_cast<unsigned long long>(record.lost()),
                      static_cast<unsigned long long>(record.withoutColour()),
                      inSeconds(record.longestInterval()) * 1e3, record.outages().size(),
                      inSeconds(gone));
  return text.data();
}

}  // namespace appliance

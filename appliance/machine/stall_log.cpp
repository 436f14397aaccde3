#include "appliance/machine/stall_log.h"

#include <algorithm>
#include <cstdio>

namespace appliance {
namespace {

double ms(rt::Nanoseconds time) {
  return static_cast<double>(time.count()) / 1e6;
}

}  // namespace

void StallLog::take(const Stall& stall) {
  if (last_ && stall.begin <= last_->end && stall.end >= last_->begin) {
    last_->begin = std::min(last_->begin, stall.begin);
    last_->end = std::max(last_->end, stall.end);
  } else {
    ++count_;
    if (!last_ || stall.end > last_->end) last_ = stall;  // else a CPU that reports late
  }
  longest_ = std::max({longest_, last_->length(), stall.length()});
}

std::string StallLog::text(rt::Timestamp now) const {
  if (!last_) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "this PC stood still for %.0f ms %.0f s ago (firmware or host); %llu times so far, "
                "%.0f ms at most",
                ms(last_->length()), ms(now - last_->end) / 1e3,
                static_cast<unsigned long long>(count_), ms(longest_));
  return text;
}

}  // namespace appliance

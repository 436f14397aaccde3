#include "appliance/machine/stall_log.h"

#include <algorithm>

#include "appliance/words/phrase.h"

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
  return textOf(phrase<Word::kMachineStalled>(ms(last_->length()), ms(now - last_->end) / 1e3,
                                              count_, ms(longest_)));
}

}  // namespace appliance

#pragma once

#include <cmath>

#include "rt/clock.h"

namespace appliance {

/// Numbers of the configuration as durations, rounded to the nanosecond.
[[nodiscard]] inline rt::Nanoseconds periodOf(double rate_hz) {
  return rt::Nanoseconds{std::llround(1e9 / rate_hz)};
}

[[nodiscard]] inline rt::Nanoseconds microseconds(double us) {
  return rt::Nanoseconds{std::llround(us * 1e3)};
}

}  // namespace appliance

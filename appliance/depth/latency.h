#pragma once

#include <expected>
#include <span>
#include <string>

#include "rt/clock.h"

namespace appliance {

/// How bright a lamp is in one picture, and when that picture seems to have been taken if the
/// sensor's latency were none.
struct LampSample {
  rt::Timestamp at;
  double brightness = 0;
};

/// From @p at on the lamp is on or off.
struct LampChange {
  rt::Timestamp at;
  bool on = false;
};

struct MeasuredLatency {
  rt::Nanoseconds latency{};
  double correlation = 0;   ///< of brightness and lamp at that latency; 1: they are one
  std::size_t changes = 0;  ///< that were seen
};

/// The latency at which the pictures agree best with what the lamp is known to have done: the
/// largest correlation of the brightness at t with the lamp at t - latency, between 0 and 300 ms.
/// Pictures sample the lamp at random phases, so many changes give a finer answer than their
/// period. Pure.
///
/// Errors  One line for a person: too few changes, or the pictures do not follow the lamp.
[[nodiscard]] std::expected<MeasuredLatency, std::string> measureLatency(
    std::span<const LampSample> samples, std::span<const LampChange> changes);

}  // namespace appliance

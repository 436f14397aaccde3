#pragma once

#include <chrono>
#include <cmath>
#include <optional>

#include "hal/display_timing.h"
#include "rt/annotations.h"
#include "rt/clock.h"

namespace appliance {

/// When the picture that is being decided will be on the screen. Everything that moves is placed
/// by this instant, not by the instant of the decision: only so does it move evenly.
struct Presentation {
  rt::Timestamp at;
  rt::Nanoseconds refresh{};  ///< from vblank to vblank; zero: no vblanks are known

  /// More than the error of a predicted vblank.
  static constexpr rt::Nanoseconds kSurelyPast = std::chrono::microseconds(200);

  /// A commit before this would show the picture a vblank too early.
  [[nodiscard]] rt::Timestamp earliestCommit() const RT_SAFE { return at - refresh + kSurelyPast; }
};

/// Of a picture that is begun @p now.
[[nodiscard]] inline Presentation presentationOf(
    rt::Timestamp now, const std::optional<hal::DisplayTiming>& timing) RT_SAFE {
  constexpr rt::Nanoseconds kUsualLatency = std::chrono::milliseconds(10);
  if (!timing) return {.at = now + kUsualLatency};
  const auto vblank = timing->firstVblankAfter(now + timing->draw + timing->commit_margin);
  return {.at = timing->vblankAt(vblank),
          .refresh = rt::Nanoseconds(std::llround(timing->period_ns))};
}

/// When the next picture of something that moves is to be begun: just after the next vblank, so
/// that each vblank gets its own decision.
[[nodiscard]] inline std::optional<rt::Timestamp> nextMovingPicture(
    rt::Timestamp now, const std::optional<hal::DisplayTiming>& timing) RT_SAFE {
  if (!timing) return std::nullopt;
  return timing->vblankAt(timing->firstVblankAfter(now - Presentation::kSurelyPast)) +
         Presentation::kSurelyPast;
}

}  // namespace appliance

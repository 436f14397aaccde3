#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rt/clock.h"

namespace appliance {

enum class GenlockState : std::uint8_t {
  kOff,          ///< not asked for
  kFreeRunning,  ///< triggers at the configured rate, whatever the screen does
  kAcquiring,    ///< the phase is being moved
  kLocked,       ///< every trigger a whole number of vblanks after the one before, in phase
};

/// Why it is not locked, or no longer.
enum class GenlockReason : std::uint8_t {
  kNone,
  kNoVblanks,  ///< not known yet, or none seen for Genlock::kHoldOver
  kRatio,      ///< the refresh rate is no whole multiple of the trigger rate
  kNoFrames,   ///< too few frames were shown to know how long they take
  kPhaseLost,  ///< the vblanks are not where they were expected
};

/// As the trace and the control interface write them, in the order of the enumerations.
inline constexpr std::array<std::string_view, 4> kGenlockStateNames = {"off", "free_running",
                                                                       "acquiring", "locked"};
inline constexpr std::array<std::string_view, 5> kGenlockReasonNames = {
    "none", "no_vblanks", "ratio", "no_frames", "phase_lost"};

[[nodiscard]] constexpr std::string_view nameOf(GenlockState state) {
  return kGenlockStateNames[static_cast<std::size_t>(state)];
}
[[nodiscard]] constexpr std::string_view nameOf(GenlockReason reason) {
  return kGenlockReasonNames[static_cast<std::size_t>(reason)];
}

struct GenlockStatus {
  GenlockState state = GenlockState::kOff;
  GenlockReason reason = GenlockReason::kNone;
  bool hold_over = false;                 ///< by prediction alone: no vblank seen for a while
  std::uint32_t vblanks_per_trigger = 0;  ///< 0: no lock is possible
  rt::Nanoseconds phase_error{};          ///< of the next trigger before it is corrected
  double phase_error_rms_ns = 0;          ///< since locked, the last 64 triggers or so
  rt::Nanoseconds lead{};                 ///< from trigger to the vblank it is meant for
  double vblank_period_ns = 0;            ///< 0: not known
  std::uint64_t unlocks = 0;
  GenlockReason last_unlock = GenlockReason::kNone;
};

}  // namespace appliance

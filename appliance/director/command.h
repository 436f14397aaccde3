#pragma once

#include <cstdint>
#include <type_traits>

#include "rt/clock.h"

namespace appliance {

/// What a person (by the panel) or a program (by the control interface) wants to be shown.
struct Command {
  enum class Kind : std::uint8_t {
    kGoLive,        ///< newest moment, no delay; from every mode
    kHome,          ///< the same, and the rig's middle view
    kFreezeToggle,  ///< stop at the shown moment; again: go on as before
    kDelayLess,     ///< one rung down the delay ladder
    kDelayMore,     ///< one rung up, at most to the history's end
    kSetDelay,      ///< exactly `delay`; zero is live
    kStepBack,      ///< one trigger earlier; stops first
    kStepForward,
    kViewLeft,  ///< the neighbouring view; the ends of the arc are ends
    kViewRight,
    kSetView,  ///< exactly `camera`
    kSweep,    ///< walk through all views of the stopped moment; stops first
  };
  Kind kind = Kind::kGoLive;
  std::uint32_t camera = 0;  ///< kSetView, from 0
  rt::Nanoseconds delay{};   ///< kSetDelay

  friend bool operator==(const Command&, const Command&) = default;
};
static_assert(std::is_trivially_copyable_v<Command>, "crosses threads in a ring");

}  // namespace appliance

#pragma once

#include <cstdint>

#include "rt/clock.h"

namespace emulator::studio {

/// What the cameras show, and since when.
struct PlayingMoment {
  std::uint32_t moment = 0;
  std::uint32_t moments = 4;  ///< of this round, a multiple of 4
  rt::Timestamp edge;         ///< of the trigger that shows it; the epoch: none came yet
  rt::Nanoseconds period{0};  ///< since the trigger before; zero: there was none
};

struct DepthExposure {
  rt::Timestamp at;
  std::uint32_t picture = 0;
};

/// The sensor takes its pictures thirty times a second by a clock of its own, in the same world as
/// the cameras. Where their triggers come at the play's own rate, the sensor's clock is put in
/// step with the play, so that the picture drawn for an instant is taken in that very instant. At
/// other rates the play runs slower or faster than life and the nearest picture is shown; where
/// no trigger comes, it stands. Pure.
/// @p due  one period after the exposure before
[[nodiscard]] DepthExposure nextDepthExposure(rt::Timestamp due, const PlayingMoment& playing);

}  // namespace emulator::studio

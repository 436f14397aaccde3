#pragma once

#include <atomic>

#include "appliance/director/shot.h"
#include "rt/clock.h"

namespace appliance {

/// What is on the screen now, for every thread that follows it: the panel's lamps, say.
///
/// Threads  Written by the render thread, read by any.
struct ShownBoard {
  std::atomic<Mode> mode{Mode::kLive};
  std::atomic<rt::Timestamp> exposure_middle{};  ///< of the shown moment; the epoch: not known
};
static_assert(std::atomic<rt::Timestamp>::is_always_lock_free);

}  // namespace appliance

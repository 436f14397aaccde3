#pragma once

#include "appliance/capture/genlock.h"
#include "rt/latest_value.h"
#include "rt/shared_value.h"

namespace appliance {

/// What the render thread reports to the genlock, and what the genlock reports to everyone.
///
/// Threads  input: the render thread publishes, the trigger loop takes. status: the trigger loop
///          stores, any thread below it in priority loads.
struct GenlockBoard {
  rt::LatestValue<GenlockInput> input;
  rt::SharedValue<GenlockStatus> status;
};

}  // namespace appliance

#pragma once

#include "appliance/box/part.h"

namespace appliance {

/// Watches the machine itself: its standstills, seen by the probes, go to the trace, the metrics
/// and the status.
[[nodiscard]] MadePart makeMachinePart(const Shared& shared);

}  // namespace appliance

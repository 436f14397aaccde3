#pragma once

#include <string>
#include <vector>

#include <arv.h>

#include "hal/camera_profile.h"

namespace hal::aravis {

/// Looks at the way that the camera's frames will take, after its profile was pushed and before
/// its stream is made: proves the packet size, putting a smaller one into force where the asked
/// one does not arrive, and compares its link with the plan's.
///
/// Returns what is wrong although the camera works: "cam07 (10.0.0.7): packets of 9000
/// bytes do not arrive: 1500 used; raise the MTU of eth1 (1500)".
[[nodiscard]] std::vector<std::string> checkNetwork(ArvCamera* camera,
                                                    const CameraProfile& profile);

}  // namespace hal::aravis

#pragma once

#include <cstddef>
#include <string>

#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"
#include "hal/camera_profile.h"

namespace appliance {

/// The configuration in a camera's own terms. All pure.

/// From the edge on the wire to the exposure, in every camera: the slowest opto-isolator's.
[[nodiscard]] double commonDelay_us(const CamerasSettings& config);

/// The settings of camera @p index of the rig. A resend.frame_retention_us of 0 becomes four fifths
/// of the trigger's period; a packet delay below 0, not planned yet, becomes none.
[[nodiscard]] hal::CameraProfile profileOf(const Config& site, const RigCamera& camera,
                                           std::size_t index);

/// "recv01" for camera 0.
[[nodiscard]] std::string receiveThreadName(std::size_t camera);

}  // namespace appliance

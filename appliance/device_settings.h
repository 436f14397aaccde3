#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"
#include "hal/camera_profile.h"
#include "rt/clock.h"
#include "rt/thread.h"

namespace appliance {

/// The configuration in the devices' own terms. All pure.
[[nodiscard]] rt::Nanoseconds periodOf(double rate_hz);
[[nodiscard]] rt::Nanoseconds microseconds(double us);

/// From the edge on the wire to the exposure, in every camera: the slowest opto-isolator's.
[[nodiscard]] double commonDelay_us(const Config::Cameras& config);

/// What camera @p index of the rig is told. A resend.frame_retention_us of 0 becomes four fifths
/// of the trigger's period; a packet delay below 0, not planned yet, becomes none.
[[nodiscard]] hal::CameraProfile profileOf(const Config& site, const RigCamera& camera,
                                           std::size_t index);

[[nodiscard]] std::vector<rt::Nanoseconds> delayLadder(const Config::Director& config);

[[nodiscard]] rt::ThreadConfig threadConfig(std::string name, const Config::ThreadSchedule& how);

/// "recv01" for camera 0.
[[nodiscard]] std::string receiveThreadName(std::size_t camera);

}  // namespace appliance

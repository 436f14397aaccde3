#pragma once

#include <expected>
#include <string>

#include <arv.h>

#include "hal/camera_profile.h"

namespace hal::aravis {

/// Writes every setting of the profile into the camera and reads each back. The first that is
/// not in force is the error: "cam07 (10.0.0.7): ExposureTime is 5000, wanted 1000: ...".
[[nodiscard]] std::expected<void, std::string> pushProfile(ArvCamera* camera,
                                                           const CameraProfile& profile);

}  // namespace hal::aravis

#pragma once

#include <optional>
#include <string>

#include <arv.h>

#include "hal/camera_profile.h"

namespace hal::aravis {

/// What the camera's link was negotiated to; nothing if the camera does not report it.
[[nodiscard]] std::optional<double> linkSpeed_mbps(ArvCamera* camera);

/// Whether a link of @p negotiated_mbps is slower than the plan's. One line for a person, without
/// the camera's name; empty: it is not.
[[nodiscard]] std::string slowLink(const CameraProfile& profile, double negotiated_mbps);

}  // namespace hal::aravis

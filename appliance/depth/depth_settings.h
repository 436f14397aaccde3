#pragma once

#include "appliance/config/config.h"
#include "hal/backends.h"

namespace appliance {

/// The configuration in the sensor's own terms.
[[nodiscard]] hal::DepthSensorSettings depthSensorSettings(const Config::DepthSensor& config);

}  // namespace appliance

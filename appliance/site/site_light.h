#pragma once

#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"
#include "appliance/light/light_advice.h"

namespace appliance {

/// How a site looks at its light.
[[nodiscard]] inline LightParameters lightParameters(const Config& config, const Rig& rig) {
  return {.mains_hz = config.light.mains_hz,
          .rate_hz = config.trigger.rate_hz,
          .exposure_us = config.cameras.exposure_us,
          .scale_px_m = rig.reference_focal_px / rig.reference_distance_m};
}

}  // namespace appliance

#include "appliance/depth/depth_settings.h"

#include <cmath>

namespace appliance {

hal::DepthSensorSettings depthSensorSettings(const Config::DepthSensor& config) {
  return {.source = config.source,
          .drivers = config.drivers,
          .width_px = config.width_px,
          .height_px = config.height_px,
          .rate_hz = config.rate_hz,
          .colour = config.colour,
          .latency = rt::Nanoseconds(std::llround(config.latency_ms * 1e6)),
          .repeat = config.repeat};
}

}  // namespace appliance

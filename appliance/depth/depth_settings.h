#pragma once

#include <string>

#include "hal/depth_sensor.h"

namespace appliance {

class Section;

/// What looks at the athlete's distance: section `[depth_sensor]`.
struct DepthSettings {
  std::string backend = "none";
  hal::DepthSensorSettings device;
  bool operator==(const DepthSettings&) const = default;
};

void read(Section section, DepthSettings& sensor);

}  // namespace appliance

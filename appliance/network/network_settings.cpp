#include "appliance/network/network_settings.h"

#include "appliance/config/section.h"

namespace appliance {

void read(Section section, NetworkSettings& network) {
  section.integer("uplinks", network.uplinks, {1, 64, "uplinks"});
  section.number("uplink_gbps", network.uplink_gbps, {0.1, 400, "Gb/s"});
  section.number("camera_link_gbps", network.camera_link_gbps, {0.1, 100, "Gb/s"});
  section.end();
}

}  // namespace appliance

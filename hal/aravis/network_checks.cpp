#include "hal/aravis/network_checks.h"

#include "hal/aravis/link_speed.h"
#include "hal/aravis/packet_size.h"

namespace hal::aravis {

std::vector<std::string> checkNetwork(ArvCamera* camera, const CameraProfile& profile) {
  std::vector<std::string> remarks;
  const auto remark = [&](const std::string& what) {
    if (!what.empty()) remarks.push_back(profile.name + " (" + profile.address + "): " + what);
  };
  const PacketSize size = provePacketSize(camera, profile);
  if (size.bytes != profile.packet_size_bytes) {
    arv_camera_gv_set_packet_delay(camera, size.delay_ns, nullptr);
  }
  remark(size.note);
  if (const auto mbps = linkSpeed_mbps(camera)) remark(slowLink(profile, *mbps));
  return remarks;
}

}  // namespace hal::aravis

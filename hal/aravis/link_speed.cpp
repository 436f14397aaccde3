#include "hal/aravis/link_speed.h"

#include <array>
#include <cstdio>

#include "hal/aravis/gobject.h"

namespace hal::aravis {
namespace {

std::optional<double> feature(ArvDevice* device, const char* name) {
  GlibError error;
  if (arv_device_is_feature_available(device, name, error.out()) == FALSE || error) {
    return std::nullopt;
  }
  const auto value =
      static_cast<double>(arv_device_get_integer_feature_value(device, name, error.out()));
  if (error || value <= 0) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> linkSpeed_mbps(ArvCamera* camera) {
  ArvDevice* device = arv_camera_get_device(camera);
  if (const auto mbps = feature(device, "GevLinkSpeed")) return mbps;
  // The newer name counts bytes a second.
  if (const auto bytes_per_s = feature(device, "DeviceLinkSpeed")) return *bytes_per_s * 8e-6;
  return std::nullopt;
}

std::string slowLink(const CameraProfile& profile, double negotiated_mbps) {
  if (negotiated_mbps >= 0.99 * profile.link_mbps) return {};
  const double frame_bits = 8.0 * profile.width_px * profile.height_px;
  std::array<char, 200> line{};
  (void)std::snprintf(line.data(), line.size(),
                      "its link runs at %.0f Mb/s instead of %.0f: a frame takes %.0f ms instead "
                      "of %.0f: check its cable and the switch's port",
                      negotiated_mbps, profile.link_mbps, frame_bits / negotiated_mbps * 1e-3,
                      frame_bits / profile.link_mbps * 1e-3);
  return line.data();
}

}  // namespace hal::aravis

#include "appliance/capture/camera_settings.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace appliance {
namespace {

double triggerDelay_us(const CamerasSettings& config, std::size_t camera) {
  return config.opto_delay_us.empty() ? 0 : commonDelay_us(config) - config.opto_delay_us[camera];
}

/// The longest that an incomplete frame may be waited for without holding up the next one.
constexpr double kRetentionShare = 0.8;
constexpr double kLongestRetention_us = 100'000;

hal::ResendPolicy policyOf(hal::ResendPolicy policy, double rate_hz) {
  if (policy.frame_retention_us == 0) {
    policy.frame_retention_us =
        static_cast<std::uint32_t>(std::min(kRetentionShare * 1e6 / rate_hz, kLongestRetention_us));
  }
  return policy;
}

}  // namespace

double commonDelay_us(const CamerasSettings& config) {
  return config.opto_delay_us.empty() ? 0 : std::ranges::max(config.opto_delay_us);
}

hal::CameraProfile profileOf(const Config& site, const RigCamera& camera, std::size_t index) {
  const CamerasSettings& config = site.cameras;
  std::vector<hal::ModelResendPolicy> by_model = site.resend.models;
  for (hal::ModelResendPolicy& own : by_model)
    own.policy = policyOf(own.policy, site.trigger.rate_hz);
  return {.name = camera.name,
          .address = config.addresses[index],
          .width_px = camera.width_px,
          .height_px = camera.height_px,
          .pixel_format = camera.pixel_format,
          .exposure_us = config.exposure_us,
          .gain_db = config.gain_db,
          .white_balance_rgb = config.white_balance_rgb,
          .trigger_source = config.trigger_source,
          .trigger_delay_us = triggerDelay_us(config, index),
          .packet_size_bytes = config.packet_size_bytes,
          .packet_delay_ns = static_cast<std::uint32_t>(std::max(0, config.packet_delay_ns)),
          .socket_buffer_bytes = config.socket_buffer_bytes,
          .resend = policyOf(site.resend.policy, site.trigger.rate_hz),
          .resend_by_model = std::move(by_model),
          .link_mbps = 1000 * site.network.camera_link_gbps};
}

std::string receiveThreadName(std::size_t camera) {
  char name[16];
  std::snprintf(name, sizeof name, "recv%02zu", (camera + 1) % 100);
  return name;
}

}  // namespace appliance

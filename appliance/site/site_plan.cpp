#include "appliance/site/site_plan.h"

#include <algorithm>
#include <cmath>

#include "appliance/words/phrase.h"

namespace appliance {

NetworkParameters networkParameters(const Config& config, const Rig& rig) {
  const auto pixels = [](const RigCamera& camera) {
    return std::uint64_t{camera.width_px} * camera.height_px;
  };
  const RigCamera& largest = *std::ranges::max_element(rig.cameras, {}, pixels);
  return {.cameras = static_cast<std::uint32_t>(rig.cameras.size()),
          .width_px = largest.width_px,
          .height_px = largest.height_px,
          .rate_hz = config.trigger.rate_hz,
          .packet_size_bytes = config.cameras.packet_size_bytes,
          .uplinks = config.network.uplinks,
          .uplink_gbps = config.network.uplink_gbps,
          .camera_link_gbps = config.network.camera_link_gbps};
}

std::expected<FittedSite, std::string> fitToNetwork(Config config, const Rig& rig) {
  NetworkParameters parameters = networkParameters(config, rig);
  auto plan = planNetwork(parameters);
  Phrase lowered;
  if (!plan) {
    const std::string refusal = plan.error().line();
    parameters.rate_hz = std::floor(highestRate_hz(parameters) * 10) / 10;
    if (parameters.rate_hz < kLowestRate_hz)
      return std::unexpected(withId(phrase<Word::kNetworkRefused>(refusal)));
    lowered = phrase<Word::kTriggerLowered>(parameters.rate_hz, config.trigger.rate_hz, refusal);
    config.trigger.rate_hz = parameters.rate_hz;
    plan = planNetwork(parameters);
  }
  if (config.cameras.packet_delay_ns < 0) {
    config.cameras.packet_delay_ns =
        static_cast<std::int32_t>(std::min<std::int64_t>(plan->packet_delay.count(), 1'000'000));
  }
  return FittedSite{std::move(config), lowered};
}

}  // namespace appliance

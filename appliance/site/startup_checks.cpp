#include "appliance/site/startup_checks.h"

#include <cstdio>

namespace appliance {
std::expected<void, std::string> checkTogether(const Config& config, const Rig& rig) {
  const std::size_t addresses = config.cameras.addresses.size();
  if (addresses != rig.cameras.size()) {
    return std::unexpected("cameras.addresses lists " + std::to_string(addresses) + " cameras, " +
                           config.rig.file + " describes " + std::to_string(rig.cameras.size()) +
                           ": give one address per [[camera]], in the same order");
  }
  const std::size_t opto_delays = config.cameras.opto_delay_us.size();
  if (opto_delays != 0 && opto_delays != rig.cameras.size()) {
    return std::unexpected("cameras.opto_delay_us lists " + std::to_string(opto_delays) +
                           " delays for " + std::to_string(rig.cameras.size()) +
                           " cameras: give one per camera, or []");
  }
  if (!rig.target_m.allFinite()) {
    return std::unexpected("--target: three finite numbers are needed, in metres: 0,0,1");
  }
  const double period_us = 1e6 / config.trigger.rate_hz;
  if (config.cameras.exposure_us >= period_us) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "cameras.exposure_us = %g does not fit into the trigger period of %g us: lower "
                  "it, or trigger.rate_hz",
                  config.cameras.exposure_us, period_us);
    return std::unexpected(std::string(line));
  }
  if (2 * config.trigger.pulse_width_us >= period_us) {
    return std::unexpected(
        "trigger.pulse_width_us is more than half a trigger period: lower it, or trigger.rate_hz");
  }
  return {};
}

}  // namespace appliance

#include "appliance/site/startup_checks.h"

#include "appliance/words/phrase.h"

namespace appliance {
std::expected<void, std::string> checkTogether(const Config& config, const Rig& rig) {
  const std::size_t addresses = config.cameras.addresses.size();
  if (addresses != rig.cameras.size()) {
    return std::unexpected(
        withId(phrase<Word::kConfigAddresses>(addresses, config.rig.file, rig.cameras.size())));
  }
  const std::size_t opto_delays = config.cameras.opto_delay_us.size();
  if (opto_delays != 0 && opto_delays != rig.cameras.size()) {
    return std::unexpected(
        withId(phrase<Word::kConfigOptoDelays>(opto_delays, rig.cameras.size())));
  }
  if (!rig.target_m.allFinite()) {
    return std::unexpected(withId(phrase<Word::kConfigTarget>()));
  }
  const double period_us = 1e6 / config.trigger.rate_hz;
  if (config.cameras.exposure_us >= period_us) {
    return std::unexpected(
        withId(phrase<Word::kConfigExposure>(config.cameras.exposure_us, period_us)));
  }
  if (2 * config.trigger.pulse_width_us >= period_us) {
    return std::unexpected(withId(phrase<Word::kConfigPulse>()));
  }
  return {};
}

}  // namespace appliance

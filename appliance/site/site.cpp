#include "appliance/site/site.h"

#include <utility>

#include "appliance/geometry/rig_file.h"
#include "appliance/site/site_plan.h"
#include "appliance/site/startup_checks.h"
#include "appliance/words/phrase.h"

namespace appliance {

std::expected<Site, std::string> loadSite(const std::string& config_file,
                                          const std::vector<std::string>& overrides,
                                          const std::vector<double>& target_m) {
  auto config = loadConfig(config_file, overrides);
  if (!config) return std::unexpected(withId(Word::kConfigRefused, config.error()));
  auto rig = loadRig(config->rig.file, config->cameras.pixel_format);
  if (!rig) return std::unexpected(withId(Word::kRigRefused, rig.error()));
  if (!target_m.empty()) rig->target_m = {target_m[0], target_m[1], target_m[2]};
  if (auto fits = checkTogether(*config, *rig); !fits) return std::unexpected(fits.error());
  auto fitted = fitToNetwork(std::move(*config), *rig);
  if (!fitted) return std::unexpected(fitted.error());
  Site site{std::move(fitted->config), std::move(*rig), {}};
  for (const auto* warnings : {&site.config.warnings, &site.rig.warnings})
    for (const std::string& warning : *warnings)
      site.degraded.push_back(phrase<Word::kConfigNote>(warning));
  if (!fitted->lowered.empty()) site.degraded.push_back(fitted->lowered);
  return site;
}

}  // namespace appliance

#pragma once

#include <expected>
#include <string>
#include <vector>

#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"
#include "appliance/words/phrase.h"

namespace appliance {

/// The box as a site configured it: both files, checked against each other and fitted to the
/// network.
struct Site {
  Config config;
  Rig rig;
  std::vector<Phrase> degraded;  ///< what is already known to be less than configured
};

/// @p overrides: as in loadConfig(). @p target_m: instead of the rig's; empty: the rig's.
/// Errors   One line: what is wrong in which file, and what to do.
[[nodiscard]] std::expected<Site, std::string> loadSite(const std::string& config_file,
                                                        const std::vector<std::string>& overrides,
                                                        const std::vector<double>& target_m);

}  // namespace appliance

#pragma once

#include <expected>
#include <string>

#include "appliance/config/config.h"
#include "appliance/geometry/rig.h"
#include "appliance/network/network_plan.h"
#include "appliance/words/phrase.h"

namespace appliance {

/// What a site asks of its network: every camera as large as the rig's largest.
[[nodiscard]] NetworkParameters networkParameters(const Config& config, const Rig& rig);

/// The site as its network can carry it.
struct FittedSite {
  Config config;
  Phrase lowered;  ///< why the trigger's rate is lower than configured; empty: it is not
};

/// Fills in an automatic packet delay. A rate that no link carries is lowered to the highest one
/// that fits: frames that do not fit would be lost at random, and a hall with slower pictures is
/// better off than one with none (docs/decisions/0014-network-plan.md).
///
/// Errors   One line, where not even kLowestRate_hz fits.
[[nodiscard]] std::expected<FittedSite, std::string> fitToNetwork(Config config, const Rig& rig);

inline constexpr double kLowestRate_hz = 1;

}  // namespace appliance

#pragma once

#include <expected>
#include <memory>
#include <string>

#include "appliance/config/config.h"
#include "hal/edge_input.h"
#include "hal/trigger_line.h"

namespace appliance {

/// The trigger line that the configuration names, claimed and inactive. Letting it go again leaves
/// it inactive: that is all it takes to make the wire safe after a crash.
[[nodiscard]] std::expected<std::unique_ptr<hal::TriggerLine>, std::string> openTriggerLine(
    const TriggerSettings& config);

/// The loop-back input that the configuration names, once a short test pulse on @p line came back
/// through it. To be called before any camera takes frames.
///
/// Errors  One line: the input does not open, or what is wrong with the wiring.
[[nodiscard]] std::expected<std::unique_ptr<hal::EdgeInput>, std::string> openLoopback(
    const TriggerSettings& config, hal::TriggerLine& line);

}  // namespace appliance

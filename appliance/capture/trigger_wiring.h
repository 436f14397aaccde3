#pragma once

#include <expected>
#include <memory>
#include <string>

#include "appliance/config/config.h"
#include "hal/edge_input.h"
#include "hal/trigger_line.h"

namespace appliance {

/// The trigger line that the configuration names, claimed and inactive. Releasing it leaves it
/// inactive, so opening and releasing it makes the wire safe after a crash.
[[nodiscard]] std::expected<std::unique_ptr<hal::TriggerLine>, std::string> openTriggerLine(
    const TriggerSettings& config);

/// The loop-back input that the configuration names, after a short test pulse on @p line was seen
/// at it. Call it before any camera takes frames.
///
/// Errors  One line: the input does not open, or what is wrong with the wiring.
[[nodiscard]] std::expected<std::unique_ptr<hal::EdgeInput>, std::string> openLoopback(
    const TriggerSettings& config, hal::TriggerLine& line);

}  // namespace appliance

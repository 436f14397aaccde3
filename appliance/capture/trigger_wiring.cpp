#include "appliance/capture/trigger_wiring.h"

#include <cstdint>

#include "appliance/capture/loopback.h"
#include "hal/backends.h"

namespace appliance {

std::expected<std::unique_ptr<hal::TriggerLine>, std::string> openTriggerLine(
    const TriggerSettings& config) {
  return hal::openTriggerLine(config.backend,
                              {.wire_port = static_cast<std::uint16_t>(config.wire_port),
                               .lines = config.lines,
                               .active_low = config.active_low});
}

std::expected<std::unique_ptr<hal::EdgeInput>, std::string> openLoopback(
    const TriggerSettings& config, hal::TriggerLine& line) {
  auto input = hal::openEdgeInput(config.loopback_line, config.loopback_active_low);
  if (!input) return std::unexpected(std::move(input.error()));
  if (auto wired = checkLoopback(line, **input); !wired)
    return std::unexpected(std::move(wired.error()));
  return input;
}

}  // namespace appliance

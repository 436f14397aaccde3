#pragma once

#include <expected>
#include <memory>
#include <string>

#include "hal/edge_input.h"

namespace hal::gpiod {

struct EdgeInputSettings {
  std::string line;  ///< its name
  bool active_low = false;
};

/// Claims one input line with both edges, stamped on CLOCK_MONOTONIC, not debounced.
///
/// Threads  As hal::EdgeInput.
/// Errors   A line that is absent, named twice or held by another program.
[[nodiscard]] std::expected<std::unique_ptr<EdgeInput>, std::string> openEdgeInput(
    const EdgeInputSettings& settings);

}  // namespace hal::gpiod

#pragma once

#include <optional>

#include "rt/clock.h"

namespace ui::kms {

/// When the last of a fence's conditions came true; none: not yet, or the descriptor is no fence.
[[nodiscard]] std::optional<rt::Timestamp> signalledAt(int fence);

}  // namespace ui::kms

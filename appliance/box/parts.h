#pragma once

#include <span>

#include "appliance/box/part.h"

namespace appliance {

/// The parts of the product, in the order in which they start.
[[nodiscard]] std::span<const PartEntry> productParts();

}  // namespace appliance

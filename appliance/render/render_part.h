#pragma once

#include <cstdint>

#include "appliance/box/part.h"

namespace appliance {

/// Frames of each camera that the part pins at most.
inline constexpr std::uint32_t kRenderPins = 7;

/// Shows pictures: the director's decisions, drawn and committed by the `render` thread.
///
/// Requests  screen.release, screen.take.
[[nodiscard]] MadePart makeRenderPart(const Shared& shared);

}  // namespace appliance

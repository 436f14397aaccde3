#pragma once

#include <cstdint>

#include "appliance/director/composition.h"
#include "hal/scene.h"
#include "rt/annotations.h"

namespace appliance {

/// A view in its place: cut to it, and moved so that its target stands in the middle of it. Two
/// places that touch end and begin at the same column: every pixel is drawn once.
///
/// @p plan: for the whole picture, with the target in its middle. The shared edge belongs to that
/// place of the target: a view that is moved has none.
/// Threads  Any; pure.
[[nodiscard]] hal::ViewLayer placed(const hal::WarpPlan& plan, std::uint64_t content,
                                    const Place& place, std::uint32_t width_px,
                                    std::uint32_t height_px) RT_SAFE;

}  // namespace appliance

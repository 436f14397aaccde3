#pragma once

#include <optional>

#include "appliance/geometry/homography.h"
#include "appliance/geometry/rig.h"
#include "hal/display.h"
#include "rt/annotations.h"

namespace appliance {

/// What the renderer needs to show @p source, a frame of @p camera, as @p view.
/// Nothing when the view is not valid or the frame is not of the size that was calibrated:
/// a picture warped with the wrong intrinsics would look right and be wrong.
/// RT safe.
[[nodiscard]] std::optional<hal::WarpPlan> planWarp(const RigCamera& camera, const View& view,
                                                    const hal::SourceImage& source) RT_SAFE;

}  // namespace appliance

#include "appliance/geometry/warp_planner.h"

namespace appliance {

std::optional<hal::WarpPlan> planWarp(const RigCamera& camera, const View& view,
                                      const hal::SourceImage& source) RT_SAFE {
  if (!view.valid || source.pixels == nullptr) return std::nullopt;
  if (source.width_px != camera.width_px || source.height_px != camera.height_px)
    return std::nullopt;
  return hal::WarpPlan{.source = source,
                       .H_camera_display = view.H_camera_display,
                       .lens = camera.lens,
                       .colour = camera.colour};
}

}  // namespace appliance

#include "appliance/geometry/view_set.h"

#include "appliance/geometry/warp_planner.h"

namespace appliance {

void ViewSet::update(const RigPin& rig, std::uint32_t width_px, std::uint32_t height_px,
                     const Eigen::Vector3d& target_m) RT_SAFE {
  const bool same_frame = revision_ == rig.revision() && parameters_.width_px == width_px &&
                          parameters_.height_px == height_px;
  if (same_frame && target_m_ == target_m) return;
  if (!same_frame) {
    if (!fixed_zoom_) cover_ = coverZoom(*rig, width_px, height_px);
    parameters_ = {.width_px = width_px,
                   .height_px = height_px,
                   .zoom = fixed_zoom_ ? *fixed_zoom_ : cover_->zoom};
  }
  revision_ = rig.revision();
  target_m_ = target_m;
  computeViews(*rig, target_m, parameters_, views_);
  edge_ = sharedEdge(*rig, views_, parameters_);
}

std::optional<hal::WarpPlan> ViewSet::plan(const RigPin& rig, std::uint32_t camera,
                                           const hal::SourceImage& source) const RT_SAFE {
  const RigCamera& calibrated = rig->cameras[camera];
  auto plan = planWarp(calibrated, views_[camera], source);
  if (!plan) return plan;
  plan->edge = edge_.mask;
  if (edge_.sight[camera] == Sight::kPoor)
    (void)tryNarrow(plan->edge, calibrated, views_[camera], parameters_);
  return plan;
}

}  // namespace appliance

#include "appliance/geometry/rig.h"

namespace appliance {

void fillReferences(Rig& rig) {
  double focal_px = 0;
  double distance_m = 0;
  double height_px = 0;
  for (const RigCamera& camera : rig.cameras) {
    focal_px += (camera.lens.fx_px + camera.lens.fy_px) / 2;
    distance_m += (rig.target_m - camera.centre_m()).norm();
    height_px += camera.height_px;
  }
  const auto count = static_cast<double>(rig.cameras.size());
  if (rig.reference_focal_px == 0) rig.reference_focal_px = focal_px / count;
  if (rig.reference_distance_m == 0) rig.reference_distance_m = distance_m / count;
  if (rig.reference_height_px == 0) rig.reference_height_px = height_px / count;
}

}  // namespace appliance

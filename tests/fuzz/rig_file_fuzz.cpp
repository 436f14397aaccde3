#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "appliance/geometry/rig_file.h"
#include "tests/fuzz/fuzz_target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto rig = appliance::parseRig(fuzz::text(data, size), "rig.toml");
  if (!rig) {
    fuzz::requireOneLine(rig.error());
    return 0;
  }
  fuzz::require(!rig->cameras.empty() && rig->cameras.size() <= appliance::kMaxCameras,
                "a rig has cameras, and no more than arrays hold");
  fuzz::require(rig->target_m.allFinite(), "the target is finite");
  fuzz::require(std::isfinite(rig->reference_focal_px) && rig->reference_focal_px > 0 &&
                    std::isfinite(rig->reference_distance_m) && rig->reference_distance_m > 0,
                "the references are lengths");
  const appliance::TargetVolume& volume = rig->target_volume;
  fuzz::require(
      (!volume.centre_m || volume.centre_m->allFinite()) && volume.half_size_m.minCoeff() >= 0,
      "the target volume has a size");
  for (const std::string& warning : rig->warnings) fuzz::requireOneLine(warning);
  for (const appliance::RigCamera& camera : rig->cameras) {
    const Eigen::Matrix3d& R = camera.R_cam_rig;
    fuzz::require(R.allFinite() && camera.t_cam_rig_m.allFinite(), "the pose is finite");
    fuzz::require(
        (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 && R.determinant() > 0,
        "rotations are proper");
    fuzz::require((R * rig->target_m + camera.t_cam_rig_m).z() > 0,
                  "the target lies in front of every camera");
    fuzz::require(camera.width_px > 0 && camera.height_px > 0, "pictures have a size");
    const hal::ColourModel& colour = camera.colour;
    fuzz::require(colour.black_level >= 0 && colour.black_level < 255, "white is above black");
    fuzz::require(
        std::ranges::all_of(colour.matrix, [](float x) { return std::isfinite(x); }) &&
            std::ranges::all_of(colour.vignetting, [](float x) { return std::isfinite(x); }),
        "colours are finite");
  }
  return 0;
}

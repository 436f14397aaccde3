#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace emulator::studio {

/// One body as it stands while a picture is taken: its bones in the rig frame when the shutter
/// opens and when it closes, ready for skinning.
struct PosedBody {
  std::uint32_t body = 0;  ///< which of the cast
  std::vector<Eigen::Affine3f> opens;
  std::vector<Eigen::Affine3f> closes;
};

/// All that moves, at one instant of the scene's time.
struct Moment {
  double second = 0;
  std::vector<PosedBody> bodies;
};

}  // namespace emulator::studio

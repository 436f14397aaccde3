#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "hal/emulated/studio/athlete/body.h"

namespace emulator::studio {

/// A body's surface in the rig frame while the shutter is open.
struct PosedMesh {
  struct Vertex {
    Eigen::Vector3f opens;
    Eigen::Vector3f closes;
    Eigen::Vector3f normal;
  };
  std::vector<Vertex> vertices;
  Eigen::AlignedBox3f bounds;
  float way_m = 0;  ///< the longest that any point goes meanwhile
};

/// Linear blend skinning, into the memory that @p mesh has.
void poseMesh(const Body& body, const std::vector<Eigen::Affine3f>& opens,
              const std::vector<Eigen::Affine3f>& closes, PosedMesh& mesh);

}  // namespace emulator::studio

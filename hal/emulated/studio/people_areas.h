#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/emulated/studio/posed_mesh.h"
#include "hal/emulated/studio/studio_rig.h"

namespace emulator::studio {

/// A person's body in one moment.
struct ShownBody {
  std::size_t body = 0;  ///< of the cast
  PosedMesh mesh;
  PosedMesh shadow;
};

/// A rectangle of one camera's picture and all who are in it.
struct PeopleArea {
  cv::Rect rect;
  std::vector<const ShownBody*> people;
};

/// Where people are in a picture: one rectangle each, overlapping ones joined. People who are
/// partly behind the camera are left out. Pure.
[[nodiscard]] std::vector<PeopleArea> peopleAreas(const StudioCamera& camera,
                                                  const std::vector<ShownBody>& people,
                                                  float nearest_m);

/// How many instants of the exposure make an area's blur: no point goes visibly far between two.
/// Pure.
[[nodiscard]] int blurSteps(const PeopleArea& area, const StudioCamera& camera);

}  // namespace emulator::studio

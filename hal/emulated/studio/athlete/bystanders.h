#pragma once

#include <cstdint>
#include <vector>

#include "hal/emulated/studio/athlete/performance.h"
#include "hal/emulated/studio/athlete/shape.h"

namespace emulator::studio {

/// Somebody drawn by chance: height, build, sex, hair, skin and clothes as people in a sports hall
/// have them.
[[nodiscard]] BodyShape drawShape(std::uint64_t seed);

/// Somebody else in the hall: make a Body of the shape, move it by the performance.
struct Bystander {
  BodyShape shape;
  Performance performance;
};

/// People around an athlete who works at the origin towards @p heading: they walk to and fro
/// behind, pass in front, and stand and stretch at the edge. Nobody comes nearer than 1.2 m to
/// the athlete's place. Coarser polygons than the athlete's.
/// @p count  at most 6.
[[nodiscard]] std::vector<Bystander> makeBystanders(std::uint64_t seed, int count = 3,
                                                    double heading = 0);

}  // namespace emulator::studio

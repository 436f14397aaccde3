#pragma once

#include "hal/emulated/rig/vec3.h"

namespace emulator {

/// An athlete-like figure, 1.75 m tall, standing at the origin and facing -y: rounded limbs that
/// flow into each other, described by their signed distance.
struct MannequinSurface {
  float distance_m;
  Vec3 albedo;
};

[[nodiscard]] float mannequinDistance(Vec3 point);
[[nodiscard]] MannequinSurface mannequinSurface(Vec3 point);
[[nodiscard]] Vec3 mannequinNormal(Vec3 point);

/// Where a ray meets the figure, and how much of the pixel it covers.
struct MannequinHit {
  float coverage = 0;  ///< 0..1; below 1 along the outline
  Vec3 point;
};

/// @p footprint  a pixel's width at distance 1 m.
[[nodiscard]] MannequinHit traceMannequin(Vec3 origin, Vec3 direction, float footprint);

/// How much light reaches @p point from @p light past the figure: 0..1, soft.
[[nodiscard]] float mannequinShadow(Vec3 point, Vec3 light, float softness);

}  // namespace emulator

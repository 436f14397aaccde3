#pragma once

#include "hal/emulated/rig/vec3.h"

namespace emulator {

inline constexpr Vec3 kKeyLight = {-2.6f, -3.2f, 4.6f};
inline constexpr Vec3 kFillLight = {3.0f, -1.5f, 4.6f};

/// The light that comes back along a ray from the hall's floor, walls or ceiling, without the
/// figure's direct outline but with its shadow. Linear, 1 is near full scale.
/// @p footprint  a pixel's width at distance 1 m, to draw lines no sharper than pixels.
[[nodiscard]] Vec3 shadeRoom(Vec3 origin, Vec3 direction, float footprint);

}  // namespace emulator

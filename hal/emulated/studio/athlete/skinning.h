#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "hal/emulated/studio/athlete/surface_net.h"

namespace emulator::studio {

struct Influence {
  std::array<std::uint8_t, 4> bones{};
  std::array<float, 4> weights{};
};

/// Which bones move which vertex of the skin, smooth over the joints: every vertex starts with its
/// nearest bone, then the weights diffuse over the surface (so an arm never pulls at the flank it
/// lies beside), and joints hand part of their weight to their "half" bone.
[[nodiscard]] std::vector<Influence> skinInfluences(const Polygons& skin);

/// Clothes move with the skin below: weights of the nearest skin vertices, smoothed.
[[nodiscard]] std::vector<Influence> clothInfluences(const Polygons& cloth, const Polygons& skin,
                                                     std::span<const Influence> skin_influences,
                                                     int smoothing_rounds);

}  // namespace emulator::studio

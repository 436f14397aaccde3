#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace emulator::studio {

/// Value noise in [-1, 1] with continuous curvature; lattice of 1.
[[nodiscard]] float smoothNoise(const Eigen::Vector3f& p, std::uint32_t seed);

}  // namespace emulator::studio

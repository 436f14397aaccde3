#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hal/emulated/studio/athlete/material.h"
#include "hal/emulated/studio/athlete/shape.h"
#include "hal/emulated/studio/athlete/skeleton.h"

namespace emulator::studio {

/// A point of a body's surface at rest. To pose it, sum weights[i] * bones[i] * position with the
/// matrices of a PoseAt; normals go through the linear part and are normalised again.
struct Vertex {
  Eigen::Vector3f position;  ///< metres at kRestHeight_m: also the rest position of the shader
  Eigen::Vector3f normal;
  Eigen::Vector2f uv;  ///< metres along the surface, roughly
  std::uint8_t material = 0;
  std::array<std::uint8_t, 4> bones{};
  std::array<float, 4> weights{};  ///< sum 1
};

/// One smooth skin over the skeleton, and what it wears as surfaces of their own. Skin that
/// clothes hide is left out.
struct Body {
  BodyShape shape;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> triangles;  ///< counter-clockwise from outside, one material each
  std::vector<Bone> bones;
};

/// The same shape gives the same body, bit for bit on one machine. Takes seconds.
[[nodiscard]] Body makeBody(const BodyShape& shape);

/// A ball of unit radius with the same vertex layout, weights on bone 0: scale and place it.
[[nodiscard]] Body makeBall();

}  // namespace emulator::studio

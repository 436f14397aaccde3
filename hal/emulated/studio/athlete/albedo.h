#pragma once

#include <array>

#include "hal/emulated/studio/athlete/shape.h"

namespace emulator::studio {

/// GLSL ES 3.00 source of what the surfaces of a body look like. Declares the uniforms that
/// albedoUniforms() names values for, and
///
///   vec3 athleteAlbedo(int material, vec2 uv, vec3 rest_position);   linear light, 0..1
///   vec3 athleteGround(int material, vec2 uv, vec3 rest_position);   without what is printed on it
///   vec4 athletePrint(int material, vec3 rest_position);             that, and its share
///   float athleteGloss(int material, vec3 rest_position);            0 dull .. 1 wet
///   vec3 athleteBump(int material, vec3 rest_position);              added to a unit normal at
///                                                                    rest, for pores and weave
///
/// Ground costs ten times what print does and is as smooth as the mesh: a renderer may take the one
/// per vertex and the other per pixel.
///
/// `rest_position` is Vertex::position, interpolated; `material` the vertex's, flat.
[[nodiscard]] const char* athleteAlbedoSource();

/// Values for the uniforms of one person: `athlete_skin`, `athlete_hair`, `athlete_eye`,
/// `athlete_shirt`, `athlete_trim`, `athlete_shorts`, `athlete_shoe` (vec3), `athlete_look`
/// (vec4: number on the shirt, seed in [0, 64), 1 for a woman, 0).
struct AlbedoUniform {
  const char* name;
  int components;  ///< 3 or 4
  float value[4];
};
[[nodiscard]] std::array<AlbedoUniform, 8> albedoUniforms(const BodyShape& shape);

}  // namespace emulator::studio

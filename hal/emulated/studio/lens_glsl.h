#pragma once

namespace emulator::studio {

/// Shared by all shaders that draw what a camera sees: OpenCV's lens model.
/// camera_k: k1 k2 p1 p2; camera_f: fx fy cx cy, in pixels; k3 is 0 in the studio.
inline constexpr const char* kLensGlsl = R"(
uniform vec4 camera_f;
uniform vec4 camera_k;
vec2 distort(vec2 p) {
  float r2 = dot(p, p);
  float radial = 1.0 + r2 * (camera_k.x + r2 * camera_k.y);
  return p * radial + vec2(2.0 * camera_k.z * p.x * p.y + camera_k.w * (r2 + 2.0 * p.x * p.x),
                           camera_k.z * (r2 + 2.0 * p.y * p.y) + 2.0 * camera_k.w * p.x * p.y);
}
vec2 undistort(vec2 d) {
  vec2 p = d;
  for (int i = 0; i < 9; ++i) {
    float r2 = dot(p, p);
    float radial = 1.0 + r2 * (camera_k.x + r2 * camera_k.y);
    vec2 tangential = vec2(2.0 * camera_k.z * p.x * p.y + camera_k.w * (r2 + 2.0 * p.x * p.x),
                           camera_k.z * (r2 + 2.0 * p.y * p.y) + 2.0 * camera_k.w * p.x * p.y);
    p = (d - tangential) / radial;
  }
  return p;
}
)";

}  // namespace emulator::studio

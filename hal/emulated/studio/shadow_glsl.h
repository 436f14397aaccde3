#pragma once

namespace emulator::studio {

/// Shaders of the shadows that people throw. A lamp's shadow map shows the floor as the lamp throws
/// shadows on it: where the ray from the lamp through a point meets z = 0, within shadow_area;
/// depth holds how far below the lamp the point lies.

inline constexpr const char* kShadowVertex = R"(
layout(location = 0) in vec3 opens;
uniform vec3 lamp;
uniform vec4 shadow_area;   // middle x, y, half width, half depth
uniform vec2 shadow_depth;  // nearest, farthest below the lamp
void main() {
  float below = lamp.z - opens.z;
  vec2 at = lamp.xy * below + (opens.xy - lamp.xy) * lamp.z;   // times below
  float n = shadow_depth.x, f = shadow_depth.y;
  gl_Position = vec4((at - shadow_area.xy * below) / shadow_area.zw,
                     (below * (f + n) - 2.0 * f * n) / (f - n), below);
}
)";

inline constexpr const char* kShadowFragment = R"(
void main() {}
)";

/// float seenShare(int lamp, vec3 point): how much of a lamp is not hidden by people.
inline constexpr const char* kShadowGlsl = R"(
const int kLamps = 6;
uniform vec3 lamp_at[kLamps];
uniform vec3 lamp_light[kLamps];   // radiance times area over pi, with its ripple
uniform vec2 lamp_half[kLamps];
uniform vec4 shadow_area;
uniform vec2 shadow_depth;
uniform sampler2DArray shadows;
float hashed(vec3 p) {
  p = fract(p * vec3(12.9898, 78.233, 37.719));
  p += dot(p, p.yzx + 19.19);
  return fract((p.x + p.y) * p.z);
}
float occluderBelow(vec2 uv, int lamp) {
  float z = 2.0 * textureLod(shadows, vec3(uv, float(lamp)), 0.0).r - 1.0;
  float n = shadow_depth.x, f = shadow_depth.y;
  return 2.0 * f * n / (f + n - z * (f - n));
}
float seenShare(int lamp, vec3 point) {
  vec3 l = lamp_at[lamp];
  float below = l.z - point.z;
  vec2 on_floor = l.xy + (point.xy - l.xy) * (l.z / below);
  vec2 uv = (on_floor - shadow_area.xy) / shadow_area.zw * 0.5 + 0.5;
  if (any(lessThan(uv, vec2(0.01))) || any(greaterThan(uv, vec2(0.99)))) return 1.0;
  vec2 to_uv = 0.5 / shadow_area.zw;
  float turn = 6.2831853 * hashed(point * 37.0);
  mat2 rotated = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
  const float kBias = 0.014;
  float sum = 0.0, hits = 0.0;
  for (int i = 0; i < 8; ++i) {
    float r = sqrt((float(i) + 0.5) / 8.0);
    float a = float(i) * 2.399963;
    vec2 offset = rotated * vec2(cos(a), sin(a)) * r;
    float w = occluderBelow(uv + offset * lamp_half[lamp] * 0.22 * to_uv, lamp);
    if (w < below - kBias) { sum += w; hits += 1.0; }
  }
  if (hits == 0.0) return 1.0;
  float penumbra = (below - sum / hits) / (sum / hits) * l.z / below;
  vec2 reach = max(lamp_half[lamp] * penumbra, vec2(0.012)) * to_uv;
  float lit = 0.0;
  for (int i = 0; i < 10; ++i) {
    float r = sqrt((float(i) + 0.5) / 10.0);
    float a = float(i) * 2.399963 + 0.7;
    vec2 offset = rotated * vec2(cos(a), sin(a)) * r;
    lit += occluderBelow(uv + offset * reach, lamp) < below - kBias ? 0.0 : 1.0;
  }
  return lit / 10.0;
}
)";

}  // namespace emulator::studio

#pragma once

namespace emulator::studio {

/// Shaders of the people renderer; those that ask for shadows stand behind kShadowGlsl.

/// Runs once per vertex and body: colour and gloss, kept for good. At rest the surface is dense
/// enough (a vertex every few millimetres), and a picture then costs a tenth of shading every
/// pixel. What is printed on clothes has sharper edges: that is left to the pixels.
inline constexpr const char* kPaintVertex = R"(
layout(location = 3) in vec3 rest;
layout(location = 4) in vec2 uv;
layout(location = 5) in float material;
out vec4 paint;
void main() {
  int m = int(material + 0.5);
  paint = vec4(athleteGround(m, uv, rest), athleteGloss(m, rest));
  gl_Position = vec4(0.0);
}
)";

/// Runs once per vertex and moment: the light that falls on it, kept for all cameras.
inline constexpr const char* kLightVertex = R"(
layout(location = 0) in vec3 opens;
layout(location = 2) in vec3 normal;
uniform vec3 around[6];   // irradiance over pi towards +x -x +y -y +z -z from all but the key lamps
out vec3 fallen;
void main() {
  vec3 start = opens + normal * 0.012;
  vec3 light = vec3(0.0);
  float open = 0.0, all = 0.0;
  for (int i = 0; i < kLamps; ++i) {
    vec3 way = lamp_at[i] - opens;
    float square = dot(way, way);
    vec3 to = way * inversesqrt(square);
    float strength = to.z / square;
    // Skin and cloth let some light around the edge.
    float facing = dot(normal, to);
    float wrapped = max((facing + 0.15) / 1.15, 0.0);
    float seen = wrapped > 0.0 ? seenShare(i, start) : 0.0;
    light += lamp_light[i] * (strength * wrapped * seen);
    open += strength * (wrapped > 0.0 ? seen : 0.5);
    all += strength;
  }
  // Where lamps are hidden by the body itself, so is part of the room.
  float hidden = mix(0.42, 1.0, open / all);
  vec3 n2 = normal * normal;
  vec3 room = n2.x * (normal.x > 0.0 ? around[0] : around[1]) +
              n2.y * (normal.y > 0.0 ? around[2] : around[3]) +
              n2.z * (normal.z > 0.0 ? around[4] : around[5]);
  fallen = light + room * hidden * mix(0.6, 1.0, smoothstep(-0.1, 0.25, opens.z));
  gl_Position = vec4(0.0);
}
)";

inline constexpr const char* kNoFragment = R"(
out vec4 unused;
void main() { unused = vec4(0.0); }
)";

/// The floor from above: what share of its light is left where people stand in it.
inline constexpr const char* kFloorFragment = R"(
uniform sampler2D floor_light;   // luminance over pi of the empty floor
uniform vec4 floor_area;         // low x, y, size x, y of this map
uniform vec4 hall_area;          // low x, y, size x, y of floor_light
uniform vec2 map_size;
out vec4 share;
/// What feet and shins close by leave of the light that comes from everywhere.
float openAt(vec2 at) {
  const float kReach = 0.17, kTall = 0.4;
  vec2 to_uv = 0.5 / shadow_area.zw;
  vec2 uv = (at - shadow_area.xy) * to_uv + 0.5;
  if (any(lessThan(uv, vec2(0.02))) || any(greaterThan(uv, vec2(0.98)))) return 1.0;
  float low = 0.0;
  for (int lamp = 0; lamp < kLamps; ++lamp) {
    for (int i = 0; i < 6; ++i) {
      float r = kReach * sqrt((float(i) + 0.5) / 6.0);
      float a = (float(i) + 0.37 * float(lamp)) * 2.399963;
      float height = lamp_at[lamp].z - occluderBelow(uv + vec2(cos(a), sin(a)) * r * to_uv, lamp);
      if (height > 0.012) low += max(1.0 - height / kTall, 0.0);
    }
  }
  return 1.0 - 0.62 * smoothstep(0.0, 0.75, low / float(6 * kLamps));
}
void main() {
  vec2 at = floor_area.xy + gl_FragCoord.xy / map_size * floor_area.zw;
  float all = texture(floor_light, (at - hall_area.xy) / hall_area.zw).r;
  float lost = 0.0, key = 0.0, hidden = 0.0;
  for (int i = 0; i < kLamps; ++i) {
    vec3 way = lamp_at[i] - vec3(at, 0.0);
    float square = dot(way, way);
    float strength = way.z * way.z / (square * square) * dot(lamp_light[i], vec3(0.2126, 0.7152, 0.0722));
    float gone = 1.0 - seenShare(i, vec3(at, 0.002));
    lost += strength * gone;
    key += strength;
    hidden += gone / float(kLamps);
  }
  float rest = max(all - key, 0.0) * min(2.2 * hidden, 0.92);
  share = vec4(clamp((1.0 - (lost + rest) / max(all, 1e-3)) * openAt(at), 0.06, 1.0), 0.0, 0.0, 1.0);
}
)";

inline constexpr const char* kBodyVertex = R"(
layout(location = 0) in vec3 opens;
layout(location = 1) in vec3 closes;
layout(location = 2) in vec3 normal;
layout(location = 3) in vec3 rest;
layout(location = 5) in float material;
layout(location = 6) in vec3 fallen;
layout(location = 7) in vec4 paint;
uniform mat3 rotation;
uniform vec3 translation;
uniform vec2 picture_size;
uniform vec2 near_far;
uniform vec3 eye;
uniform float instant;       // 0 when the shutter opens, 1 when it closes
out vec3 v_light;
out float v_depth;
out vec3 v_fallen;
out vec3 v_rest;
flat out int v_material;
void main() {
  vec3 world = mix(opens, closes, instant);
  vec3 p = rotation * world + translation;
  vec2 pixel = distort(p.xy / p.z) * camera_f.xy + camera_f.zw;
  vec2 ndc = (2.0 * pixel + 1.0) / picture_size - 1.0;
  float n = near_far.x, f = near_far.y;
  gl_Position = vec4(ndc * p.z, (p.z * (f + n) - 2.0 * f * n) / (f - n), p.z);
  vec3 to_eye = normalize(eye - world);
  vec3 middle = normalize(to_eye + vec3(0.0, 0.0, 1.0));
  float gloss = paint.a;
  float shine = pow(clamp(dot(normal, middle), 0.0, 1.0), mix(6.0, 60.0, gloss)) * mix(0.03, 0.55, gloss * gloss);
  float rim = pow(1.0 - clamp(dot(normal, to_eye), 0.0, 1.0), 4.0) * 0.12 * gloss;
  v_light = fallen * (paint.rgb + shine + rim);
  v_depth = p.z;
  v_fallen = fallen;
  v_rest = rest;
  v_material = int(material + 0.5);
}
)";

/// With athleteAlbedoSource() before it.
inline constexpr const char* kBodyFragment = R"(
in vec3 v_light;
in float v_depth;
in vec3 v_fallen;
in vec3 v_rest;
flat in int v_material;
uniform sampler2D behind;    // depth of the empty hall
layout(location = 0) out vec4 colour;
void main() {
  if (v_depth > texelFetch(behind, ivec2(gl_FragCoord.xy), 0).r + 0.01) discard;
  vec3 light = v_light;
  if (v_material >= 3) {
    vec4 print = athletePrint(v_material, v_rest);
    light = mix(light, v_fallen * print.rgb, print.a);
  }
  colour = vec4(sqrt(clamp(light, 0.0, 1.0)), 1.0);
}
)";

inline constexpr const char* kDepthFragment = R"(
in float v_depth;
layout(location = 0) out float depth;
void main() { depth = v_depth; }
)";

}  // namespace emulator::studio

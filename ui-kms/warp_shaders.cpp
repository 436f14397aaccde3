#include "ui-kms/warp_shaders.h"

namespace ui::shader {
namespace {

constexpr const char* kInnerVertex = R"(#version 300 es
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 texture_w;
out vec3 at;
void main() {
  at = texture_w;
  gl_Position = vec4(position, 0.0, 1.0);
}
)";

constexpr const char* kEdgeVertex = R"(#version 300 es
layout(location = 0) in vec2 position;
layout(location = 2) in vec3 ray_w;
out vec3 ray;
void main() {
  ray = ray_w;
  gl_Position = vec4(position, 0.0, 1.0);
}
)";

constexpr const char* kEverywhereVertex = R"(#version 300 es
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);  // one triangle covers all
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

constexpr const char* kHead = R"(#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D source;
out vec4 colour;
)";

// The sRGB curve (IEC 61966-2-1) from two square roots: fitted by least squares towards the
// smallest maximum over [0.0031308, 1]; off by less than 0.1 of an 8-bit code. Measured on
// llvmpipe it costs a third of what an sRGB framebuffer's own encoding does, and a buffer that
// is scanned out need not be an sRGB one.
constexpr const char* kEncode = R"(
vec3 encode(vec3 c) {
  vec3 s = sqrt(c);
  vec3 q = sqrt(s);
  vec3 curve = 0.833737059 * s + 0.298125661 * q - 0.0553151394 * c - 0.0769081045;
  return mix(curve, 12.92 * c, lessThan(c, vec3(0.0031308)));
}
)";

// From the stored value to linear light.
constexpr const char* kLight = R"(
uniform vec3 gain_rgb;
vec3 light(vec3 stored) { return stored * gain_rgb; }
)";

// seen(): linear light, and how much of the pixel the camera sees.
constexpr const char* kInnerSeen = R"(
in vec3 at;
vec4 seen() { return vec4(light(textureProj(source, at).rgb), 1.0); }
)";

// The whole map per pixel. Outside the source a texel counts as unseen, which weighs the lookup by
// the part of its footprint that is inside.
constexpr const char* kEdgeSeen = R"(
in vec3 ray;
uniform vec2 focal_px, centre_px, source_px, tangential;
uniform vec3 radial;
uniform float max_radius2;
vec4 seen() {
  vec2 n = (ray.xy / ray.z - centre_px) / focal_px;
  vec2 n2 = n * n;
  float r2 = n2.x + n2.y;
  float scale = 1.0 + r2 * (radial.x + r2 * (radial.y + r2 * radial.z));
  vec2 d = n * scale + 2.0 * n.x * n.y * tangential + tangential.yx * (r2 + 2.0 * n2);
  vec2 at_px = d * focal_px + centre_px;
  vec2 inside = clamp(at_px + 1.0, 0.0, 1.0) * clamp(source_px - at_px, 0.0, 1.0);
  bool valid = ray.z > 0.0 && r2 <= max_radius2;
  vec4 view = vec4(light(texture(source, (at_px + 0.5) / source_px).rgb), inside.x * inside.y);
  return valid ? view : vec4(0.0);
}
)";

constexpr const char* kToScreen = R"(
void main() {
  vec4 view = seen();
  colour = vec4(encode(min(view.rgb * view.a, 1.0)), 1.0);
}
)";

constexpr const char* kToLinear = R"(
uniform float opacity;
void main() {
  vec4 view = seen();
  float cover = view.a * opacity;
  colour = vec4(min(view.rgb, 1.0) * cover, cover);
}
)";

constexpr const char* kLinearToScreen = R"(
void main() {
  colour = vec4(encode(min(texelFetch(source, ivec2(gl_FragCoord.xy), 0).rgb, 1.0)), 1.0);
}
)";

std::string joined(const char* a, const char* b, const char* c, const char* d = "") {
  return std::string(kHead) + a + b + c + d;
}

}  // namespace

std::string innerVertex() {
  return kInnerVertex;
}
std::string edgeVertex() {
  return kEdgeVertex;
}
std::string innerToScreen() {
  return joined(kEncode, kLight, kInnerSeen, kToScreen);
}
std::string edgeToScreen() {
  return joined(kEncode, kLight, kEdgeSeen, kToScreen);
}
std::string innerToLinear() {
  return joined(kLight, kInnerSeen, kToLinear);
}
std::string edgeToLinear() {
  return joined(kLight, kEdgeSeen, kToLinear);
}
std::string everywhereVertex() {
  return kEverywhereVertex;
}
std::string linearToScreen() {
  return joined(kEncode, kLinearToScreen, "");
}

}  // namespace ui::shader

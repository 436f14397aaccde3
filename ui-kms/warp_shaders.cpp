#include "ui-kms/warp_shaders.h"

#include <initializer_list>

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

constexpr const char* kSoftVertex = R"(#version 300 es
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 texture_w;
layout(location = 3) in vec2 upright;
out vec3 at;
out vec2 place;
void main() {
  at = texture_w;
  place = upright;
  gl_Position = vec4(position, 0.0, 1.0);
}
)";

constexpr const char* kEdgeVertex = R"(#version 300 es
layout(location = 0) in vec2 position;
layout(location = 2) in vec3 ray_w;
layout(location = 3) in vec2 upright;
out vec3 ray;
out vec2 place;
void main() {
  ray = ray_w;
  place = upright;
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

// seen(): linear light, and how much of the pixel is picture.
constexpr const char* kInnerSeenGains = R"(
uniform vec3 gain_rgb;
in vec3 at;
vec4 seen() { return vec4(textureProj(source, at).rgb * gain_rgb, part()); }
)";

// From the stored value to linear light: hal::ColourModel. The gains are part of the matrix.
constexpr const char* kLight = R"(
uniform vec2 centre_px, source_px;
uniform mat3 from_camera;
uniform vec3 vignetting;
uniform float black;
vec3 light(vec3 stored, vec2 at_px) {
  vec2 off = at_px - centre_px;
  float r2 = 4.0 * dot(off, off) / dot(source_px, source_px);
  float fall_off = 1.0 + r2 * (vignetting.x + r2 * (vignetting.y + r2 * vignetting.z));
  return max(from_camera * ((stored - black) / ((1.0 - black) * fall_off)), 0.0);
}
)";

constexpr const char* kInnerSeenModel = R"(
in vec3 at;
vec4 seen() {
  vec2 at_px = at.xy / at.z * source_px - 0.5;
  return vec4(light(textureProj(source, at).rgb, at_px), part());
}
)";

constexpr const char* kInnerPart = R"(
float part() { return 1.0; }
)";

// How much of the picture is shown at a place of the display, from -1 to 1 in both directions: what
// hal::EdgeMask says, with its soft edge.
constexpr const char* kEdgeMask = R"(
uniform float narrowing[64];
float shownAt(vec2 p) {
  vec2 size = abs(p);
  float outwards = max(max(size.x, size.y), 1e-6);
  bool steep = size.y >= size.x;
  float side = steep ? (p.y < 0.0 ? 0.0 : 2.0) : (p.x > 0.0 ? 1.0 : 3.0);
  float along = (steep ? (p.y < 0.0 ? p.x : -p.x) : (p.x > 0.0 ? p.y : -p.y)) / outwards;
  float at = (side + (along + 1.0) / 2.0) * 16.0;
  int before = int(at);
  float narrow =
      mix(narrowing[before & 63], narrowing[(before + 1) & 63], at - float(before));
  return smoothstep(0.0, 0.02, 1.0 - outwards * narrow);
}
)";

constexpr const char* kSoftPart = R"(
in vec2 place;
float part() { return shownAt(place); }
)";

// The whole map per pixel. Outside the source a texel counts as unseen, which weighs the lookup by
// the part of its footprint that is inside.
constexpr const char* kEdgeSeen = R"(
in vec3 ray;
in vec2 place;
uniform vec2 focal_px, tangential;
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
  vec3 stored = texture(source, (at_px + 0.5) / source_px).rgb;
  vec4 view = vec4(light(stored, at_px), inside.x * inside.y * shownAt(place));
  return valid ? view : vec4(0.0);
}
)";

constexpr const char* kToScreen = R"(
const vec3 surround = vec3(0.006048);
void main() {
  vec4 view = seen();
  colour = vec4(encode(mix(surround, min(view.rgb, 1.0), view.a)), 1.0);
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

std::string joined(std::initializer_list<const char*> pieces) {
  std::string all = kHead;
  for (const char* piece : pieces) all += piece;
  return all;
}

std::string seenInside(Colour colour, std::string before, const char* after) {
  if (colour == Colour::kModel) before += kLight;
  return before + (colour == Colour::kGains ? kInnerSeenGains : kInnerSeenModel) + after;
}

}  // namespace

std::string innerVertex() {
  return kInnerVertex;
}
std::string edgeVertex() {
  return kEdgeVertex;
}
std::string softVertex() {
  return kSoftVertex;
}
std::string innerToScreen(Colour colour) {
  return seenInside(colour, joined({kEncode, kInnerPart}), kToScreen);
}
std::string softToScreen(Colour colour) {
  return seenInside(colour, joined({kEncode, kEdgeMask, kSoftPart}), kToScreen);
}
std::string edgeToScreen() {
  return joined({kEncode, kLight, kEdgeMask, kEdgeSeen, kToScreen});
}
std::string innerToLinear(Colour colour) {
  return seenInside(colour, joined({kInnerPart}), kToLinear);
}
std::string softToLinear(Colour colour) {
  return seenInside(colour, joined({kEdgeMask, kSoftPart}), kToLinear);
}
std::string edgeToLinear() {
  return joined({kLight, kEdgeMask, kEdgeSeen, kToLinear});
}
std::string everywhereVertex() {
  return kEverywhereVertex;
}
std::string linearToScreen() {
  return joined({kEncode, kLinearToScreen});
}

}  // namespace ui::shader

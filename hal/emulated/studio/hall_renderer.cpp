#include "hal/emulated/studio/hall_renderer.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "hal/emulated/studio/lens_glsl.h"

namespace emulator::studio {
namespace {

constexpr double kOversampling = 1.6;
constexpr double kMirrorScale = 0.35;  // a varnish mirrors softly
constexpr float kNear_m = 0.3f;
constexpr float kFar_m = 60;

const char* const kSurfaceVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_at;
layout(location = 3) in vec3 tint;
layout(location = 4) in vec2 light_at;
uniform mat3 rotation;       // rig to camera
uniform vec3 translation;
uniform vec4 pinhole;        // fx fy cx cy
uniform vec2 picture_size;
uniform vec2 near_far;
uniform float mirror;        // -1 draws the hall upside down below the floor
out vec3 v_position;
out vec3 v_normal;
out vec2 v_texture;
out vec3 v_tint;
out vec2 v_light;
out float v_depth;
void main() {
  vec3 world = vec3(position.xy, position.z * mirror);
  vec3 p = rotation * world + translation;
  vec2 pixel = pinhole.xy * p.xy + pinhole.zw * p.z;   // times depth
  vec2 ndc = (2.0 * pixel + p.z) / picture_size - p.z;
  float n = near_far.x, f = near_far.y;
  gl_Position = vec4(ndc.x, ndc.y, (p.z * (f + n) - 2.0 * f * n) / (f - n), p.z);
  v_position = world;
  v_normal = vec3(normal.xy, normal.z * mirror);
  v_texture = texture_at;
  v_tint = tint;
  v_light = light_at;
  v_depth = p.z;
}
)";

const char* const kSurfaceFragment = R"(
in vec3 v_position;
in vec3 v_normal;
in vec2 v_texture;
in vec3 v_tint;
in vec2 v_light;
in float v_depth;
uniform sampler2D cover;
uniform sampler2D grain;
uniform sampler2D light;
uniform sampler2D mirrored;
uniform int kind;            // 0 painted, 1 floor, 2 glows, 3 net
uniform vec3 eye;
uniform vec2 picture_size;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;
void main() {
  depth = v_depth;
  if (kind == 2) { colour = vec4(v_tint, 0.0); return; }
  vec4 paint = texture(cover, v_texture, -0.6);
  if (kind == 3 && paint.a < 0.30) discard;
  vec3 albedo = paint.rgb * v_tint;
  vec4 fall = texture(light, v_light);
  float swing = fall.a / max(dot(fall.rgb, vec3(0.2126, 0.7152, 0.0722)), 1e-4);
  vec3 to_eye = normalize(eye - v_position);
  if (kind == 1) {
    vec3 g = texture(grain, v_position.xy / 1.6, -0.5).rgb;
    albedo *= 0.35 + 3.0 * g.g;   // sRGB 128 is 0.216 in linear light
    float facing = max(to_eye.z, 0.0);
    float fresnel = 0.045 + 0.75 * pow(1.0 - facing, 5.0);
    vec2 at = gl_FragCoord.xy / picture_size;
    vec3 other = 0.5 * textureLod(mirrored, at, 1.2).rgb + 0.5 * textureLod(mirrored, at, 3.2).rgb;
    colour = vec4(albedo * fall.rgb * (1.0 - fresnel) + min(other, vec3(6.0)) * fresnel * (0.75 + 1.1 * (g.g - 0.1)), swing);
    return;
  }
  colour = vec4(albedo * fall.rgb, swing);
}
)";

const char* const kLensVertex = R"(
void main() {
  vec2 corner = vec2(float((gl_VertexID & 1) << 2) - 1.0, float((gl_VertexID & 2) << 1) - 1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

const char* const kLensFragment = R"(
uniform sampler2D wide;
uniform sampler2D wide_depth;
uniform vec4 pinhole;
uniform vec2 picture_size;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;
void main() {
  vec2 at = undistort((gl_FragCoord.xy - 0.5 - camera_f.zw) / camera_f.xy) * pinhole.xy + pinhole.zw + 0.5;
  depth = texelFetch(wide_depth, ivec2(at), 0).r;
  // A pixel and a little of its neighbours, as a lens of fair quality draws it.
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float w = (x == 0 ? 2.0 : 1.0) * (y == 0 ? 2.0 : 1.0);
      vec4 tap = texture(wide, (at + vec2(x, y) * 1.0) / picture_size);
      sum += w * vec4(min(tap.rgb, vec3(4.0)), tap.a);
      weights += w;
    }
  }
  colour = sum / weights;
}
)";

struct Corner {
  float position[3];
  float normal[3];
  float texture[2];
  float tint[3];
  float light[2];
};

int kindOf(Cover cover) {
  switch (cover) {
    case Cover::kFloor:
      return 1;
    case Cover::kGlow:
      return 2;
    case Cover::kNet:
      return 3;
    default:
      return 0;
  }
}

gl::Texture upload(const cv::Mat& rgba, GLenum format) {
  const int levels = static_cast<int>(std::log2(std::max(rgba.cols, rgba.rows))) + 1;
  gl::Texture texture =
      gl::makeTexture(format, rgba.cols, rgba.rows, GL_LINEAR_MIPMAP_LINEAR, GL_REPEAT, levels);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, rgba.cols, rgba.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                  rgba.data);
  glGenerateMipmap(GL_TEXTURE_2D);
  constexpr GLenum kAnisotropy =
      0x84FE;  // GL_EXT_texture_filter_anisotropic; else an ignored error
  glTexParameterf(GL_TEXTURE_2D, kAnisotropy, 8);
  while (glGetError() != GL_NO_ERROR) {
  }
  return texture;
}

void bindTexture(int unit, const gl::Texture& texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture.get());
}

}  // namespace

HallRenderer::HallRenderer(const std::vector<Surface>& surfaces, const CoverPictures& covers,
                           const cv::Mat& floor_grain, const LightMap& light)
    : vertex_array_(gl::makeVertexArray()),
      vertices_(gl::makeBuffer()),
      indices_(gl::makeBuffer()) {
  std::vector<Corner> corners;
  std::vector<std::uint32_t> indices;
  for (std::size_t cover = 0; cover < kCoverCount; ++cover) {
    Batch batch{.cover = static_cast<Cover>(cover), .first = static_cast<GLsizei>(indices.size())};
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const Surface& s = surfaces[i];
      if (s.cover != batch.cover) continue;
      const auto base = static_cast<std::uint32_t>(corners.size());
      const LightMap::Place& place = light.places[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const float u = static_cast<float>(place.x) + 0.5f +
                        (k % 2 == 0 ? 0 : static_cast<float>(place.width - 1));
        const float v = static_cast<float>(place.y) + 0.5f +
                        (k / 2 == 0 ? 0 : static_cast<float>(place.height - 1));
        const auto& p = s.corners[k];
        const auto& n = s.normals[k];
        const auto& t = s.texture[k];
        corners.push_back(
            {{p.x(), p.y(), p.z()},
             {n.x(), n.y(), n.z()},
             {t.x(), t.y()},
             {s.tint.x(), s.tint.y(), s.tint.z()},
             {u / static_cast<float>(light.width), v / static_cast<float>(light.height)}});
      }
      for (const std::uint32_t k : {0u, 1u, 2u, 2u, 1u, 3u}) indices.push_back(base + k);
    }
    batch.count = static_cast<GLsizei>(indices.size()) - batch.first;
    if (batch.count > 0) batches_.push_back(batch);
  }
  glBindVertexArray(vertex_array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)),
               corners.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STATIC_DRAW);
  const auto attribute = [](GLuint index, GLint size, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(Corner),
                          reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, offsetof(Corner, position));
  attribute(1, 3, offsetof(Corner, normal));
  attribute(2, 2, offsetof(Corner, texture));
  attribute(3, 3, offsetof(Corner, tint));
  attribute(4, 2, offsetof(Corner, light));
  glBindVertexArray(0);

  for (std::size_t i = 0; i < kCoverCount; ++i) covers_[i] = upload(covers[i], GL_SRGB8_ALPHA8);
  grain_ = upload(floor_grain, GL_SRGB8_ALPHA8);
  light_ = gl::makeTexture(GL_RGBA32F, static_cast<GLsizei>(light.width),
                           static_cast<GLsizei>(light.height), GL_LINEAR, GL_CLAMP_TO_EDGE);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(light.width),
                  static_cast<GLsizei>(light.height), GL_RGBA, GL_FLOAT, light.texels.data());
  surface_program_ = makeProgram("hall", kSurfaceVertex, kSurfaceFragment);
  lens_program_ = makeProgram("lens", kLensVertex, std::string(kLensGlsl) + kLensFragment);
}

HallRenderer::Pinhole HallRenderer::widen(const StudioCamera& camera, double scale) {
  const CameraModel& m = camera.model;
  const double width = m.image_size.width;
  const double height = m.image_size.height;
  std::vector<cv::Point2d> border;
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = -1 + (width + 1) * i / kSteps;
    const double y = -1 + (height + 1) * i / kSteps;
    border.insert(border.end(), {{x, -1}, {x, height}, {-1, y}, {width, y}});
  }
  const cv::Matx33d intrinsics(m.focal_px[0], 0, m.centre_px[0], 0, m.focal_px[1], m.centre_px[1],
                               0, 0, 1);
  std::vector<cv::Point2d> straight;
  const cv::TermCriteria precise(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 1e-9);
  cv::undistortPoints(border, straight, intrinsics,
                      cv::Mat(1, 5, CV_64F, const_cast<double*>(m.distortion.data())),
                      cv::noArray(), cv::noArray(), precise);
  double left = 0, right = 0, top = 0, bottom = 0;
  for (const cv::Point2d& p : straight) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  const double fx = m.focal_px[0] * scale;
  const double fy = m.focal_px[1] * scale;
  constexpr double kMargin = 4;
  return {.width = static_cast<int>(std::ceil((right - left) * fx + 2 * kMargin)),
          .height = static_cast<int>(std::ceil((bottom - top) * fy + 2 * kMargin)),
          .f = {static_cast<float>(fx), static_cast<float>(fy),
                static_cast<float>(-left * fx + kMargin), static_cast<float>(-top * fy + kMargin)}};
}

void HallRenderer::drawSurfaces(const StudioCamera& camera, const Pinhole& pinhole,
                                bool mirrored) const {
  const Eigen::Matrix3f rotation = camera.rotation().cast<float>();
  const Eigen::Vector3f eye = camera.centre().cast<float>();
  const auto& t = camera.model.translation_m;
  const gl::Program& program = surface_program_;
  glUseProgram(program.get());
  glUniformMatrix3fv(uniform(program, "rotation"), 1, GL_FALSE, rotation.data());
  glUniform3f(uniform(program, "translation"), static_cast<float>(t[0]), static_cast<float>(t[1]),
              static_cast<float>(t[2]));
  glUniform4fv(uniform(program, "pinhole"), 1, pinhole.f.data());
  glUniform2f(uniform(program, "picture_size"), static_cast<float>(pinhole.width),
              static_cast<float>(pinhole.height));
  glUniform2f(uniform(program, "near_far"), kNear_m, kFar_m);
  glUniform1f(uniform(program, "mirror"), mirrored ? -1.0f : 1.0f);
  glUniform3f(uniform(program, "eye"), eye.x(), eye.y(), eye.z());
  glUniform1i(uniform(program, "cover"), 0);
  glUniform1i(uniform(program, "grain"), 1);
  glUniform1i(uniform(program, "light"), 2);
  glUniform1i(uniform(program, "mirrored"), 3);
  bindTexture(1, grain_);
  bindTexture(2, light_);
  if (!mirrored) bindTexture(3, mirrored_);
  glViewport(0, 0, pinhole.width, pinhole.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  const GLfloat kBlack[] = {0, 0, 0, 0};
  const GLfloat kFarAway[] = {kFar_m, 0, 0, 0};
  const GLfloat kDeep = 1;
  glClearBufferfv(GL_COLOR, 0, kBlack);
  if (!mirrored) glClearBufferfv(GL_COLOR, 1, kFarAway);
  glClearBufferfv(GL_DEPTH, 0, &kDeep);
  glBindVertexArray(vertex_array_.get());
  for (const Batch& batch : batches_) {
    if (mirrored && batch.cover == Cover::kFloor) continue;
    bindTexture(0, covers_[static_cast<std::size_t>(batch.cover)]);
    glUniform1i(uniform(program, "kind"), kindOf(batch.cover));
    glDrawElements(GL_TRIANGLES, batch.count, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(static_cast<std::size_t>(batch.first) *
                                                 sizeof(std::uint32_t)));
  }
  glBindVertexArray(0);
}

Backdrop HallRenderer::draw(const StudioCamera& camera) {
  const auto target = [](const gl::Texture& colour, const gl::Texture* depth) {
    gl::Framebuffer framebuffer = gl::makeFramebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour.get(), 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    if (depth != nullptr)
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, depth->get(), 0);
    glDrawBuffers(depth == nullptr ? 1 : 2, both);
    return framebuffer;
  };
  const auto depthBuffer = [](const Pinhole& size) {
    gl::Renderbuffer buffer = gl::makeRenderbuffer();
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.get());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, size.width, size.height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffer.get());
    return buffer;
  };

  {
    const Pinhole half = widen(camera, kMirrorScale);
    mirrored_ = gl::makeTexture(GL_RGBA16F, half.width, half.height, GL_LINEAR_MIPMAP_LINEAR,
                                GL_CLAMP_TO_EDGE, 6);
    const gl::Framebuffer framebuffer = target(mirrored_, nullptr);
    const gl::Renderbuffer depth = depthBuffer(half);
    drawSurfaces(camera, half, true);
    bindTexture(3, mirrored_);
    glGenerateMipmap(GL_TEXTURE_2D);
  }
  const Pinhole wide = widen(camera, kOversampling);
  const gl::Texture wide_colour =
      gl::makeTexture(GL_RGBA16F, wide.width, wide.height, GL_LINEAR, GL_CLAMP_TO_EDGE);
  const gl::Texture wide_depth =
      gl::makeTexture(GL_R32F, wide.width, wide.height, GL_NEAREST, GL_CLAMP_TO_EDGE);
  {
    const gl::Framebuffer framebuffer = target(wide_colour, &wide_depth);
    const gl::Renderbuffer depth = depthBuffer(wide);
    drawSurfaces(camera, wide, false);
  }

  const CameraModel& m = camera.model;
  Backdrop out{.width = m.image_size.width,
               .height = m.image_size.height,
               .rgb = {},
               .ripple = {},
               .depth_m = {}};
  const auto width = static_cast<int>(out.width);
  const auto height = static_cast<int>(out.height);
  const gl::Texture colour =
      gl::makeTexture(GL_RGBA32F, width, height, GL_NEAREST, GL_CLAMP_TO_EDGE);
  const gl::Texture depth = gl::makeTexture(GL_R32F, width, height, GL_NEAREST, GL_CLAMP_TO_EDGE);
  const gl::Framebuffer framebuffer = target(colour, &depth);
  glDisable(GL_DEPTH_TEST);
  glViewport(0, 0, width, height);
  glUseProgram(lens_program_.get());
  const auto value = [](double v) { return static_cast<float>(v); };
  glUniform4f(uniform(lens_program_, "camera_f"), value(m.focal_px[0]), value(m.focal_px[1]),
              value(m.centre_px[0]), value(m.centre_px[1]));
  glUniform4f(uniform(lens_program_, "camera_k"), value(m.distortion[0]), value(m.distortion[1]),
              value(m.distortion[2]), value(m.distortion[3]));
  glUniform4fv(uniform(lens_program_, "pinhole"), 1, wide.f.data());
  glUniform2f(uniform(lens_program_, "picture_size"), value(wide.width), value(wide.height));
  glUniform1i(uniform(lens_program_, "wide"), 0);
  glUniform1i(uniform(lens_program_, "wide_depth"), 1);
  bindTexture(0, wide_colour);
  bindTexture(1, wide_depth);
  glBindVertexArray(vertex_array_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);

  const std::size_t pixels = std::size_t{out.width} * out.height;
  std::vector<float> rgba(pixels * 4);
  out.depth_m.resize(pixels);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, rgba.data());
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, out.depth_m.data());
  out.rgb.resize(pixels * 3);
  out.ripple.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    std::copy_n(&rgba[4 * i], 3, &out.rgb[3 * i]);
    out.ripple[i] = rgba[4 * i + 3];
  }
  return out;
}

}  // namespace emulator::studio

#include "ui-kms/warp_pass.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ui {
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

// The sRGB curve (IEC 61966-2-1) from two square roots: fitted by least squares towards the
// smallest maximum over [0.0031308, 1]; off by less than 0.1 of an 8-bit code. Measured on
// llvmpipe it costs a third of what an sRGB framebuffer's own encoding does, and a buffer that
// is scanned out need not be an sRGB one.
constexpr const char* kEncode = R"(#version 300 es
precision highp float;
uniform sampler2D source;
uniform vec3 gain_rgb;
out vec4 colour;
vec3 encode(vec3 linear) {
  vec3 c = min(linear * gain_rgb, 1.0);
  vec3 s = sqrt(c);
  vec3 q = sqrt(s);
  vec3 curve = 0.833737059 * s + 0.298125661 * q - 0.0553151394 * c - 0.0769081045;
  return mix(curve, 12.92 * c, lessThan(c, vec3(0.0031308)));
}
)";

constexpr const char* kInnerFragment = R"(
in vec3 at;
void main() { colour = vec4(encode(textureProj(source, at).rgb), 1.0); }
)";

// The whole map per pixel. Outside the source a texel counts as black, which weighs the lookup by
// the part of its footprint that is inside.
constexpr const char* kEdgeFragment = R"(
in vec3 ray;
uniform vec2 focal_px, centre_px, source_px, tangential;
uniform vec3 radial;
uniform float max_radius2;
void main() {
  vec2 n = (ray.xy / ray.z - centre_px) / focal_px;
  vec2 n2 = n * n;
  float r2 = n2.x + n2.y;
  float scale = 1.0 + r2 * (radial.x + r2 * (radial.y + r2 * radial.z));
  vec2 d = n * scale + 2.0 * n.x * n.y * tangential + tangential.yx * (r2 + 2.0 * n2);
  vec2 at_px = d * focal_px + centre_px;
  vec2 inside = clamp(at_px + 1.0, 0.0, 1.0) * clamp(source_px - at_px, 0.0, 1.0);
  vec3 linear = texture(source, (at_px + 0.5) / source_px).rgb * inside.x * inside.y;
  bool valid = ray.z > 0.0 && r2 <= max_radius2;
  colour = vec4(valid ? encode(linear) : vec3(0.0), 1.0);
}
)";

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

GLsizeiptr bytesOf(const auto& values) {
  return static_cast<GLsizeiptr>(values.size() * sizeof(values[0]));
}

void setGain(GLint at, const hal::WarpPlan& plan) {
  glUniform3fv(at, 1, plan.gain_rgb.data());
}

}  // namespace

std::expected<WarpPass, std::string> WarpPass::create(std::uint32_t width_px,
                                                      std::uint32_t height_px) {
  WarpPass pass(width_px, height_px);
  auto inner = gl::makeProgram("warp", kInnerVertex, std::string(kEncode) + kInnerFragment);
  if (!inner) return std::unexpected(inner.error());
  auto edge = gl::makeProgram("warp edge", kEdgeVertex, std::string(kEncode) + kEdgeFragment);
  if (!edge) return std::unexpected(edge.error());
  pass.inner_ = std::move(*inner);
  pass.edge_ = std::move(*edge);
  pass.inner_at_.gain_rgb = uniform(pass.inner_, "gain_rgb");
  const gl::Program& program = pass.edge_;
  pass.edge_at_ = {.gain_rgb = uniform(program, "gain_rgb"),
                   .focal_px = uniform(program, "focal_px"),
                   .centre_px = uniform(program, "centre_px"),
                   .radial = uniform(program, "radial"),
                   .tangential = uniform(program, "tangential"),
                   .max_radius2 = uniform(program, "max_radius2"),
                   .source_px = uniform(program, "source_px")};
  pass.makeBuffers();
  return pass;
}

void WarpPass::makeBuffers() {
  const double width_px = mesh_.columnPx(mesh_.columns() - 1) + 0.5;
  const double height_px = mesh_.rowPx(mesh_.rows() - 1) + 0.5;
  std::vector<float> positions;
  for (std::uint32_t j = 0; j < mesh_.rows(); ++j) {
    for (std::uint32_t i = 0; i < mesh_.columns(); ++i) {
      positions.push_back(static_cast<float>((mesh_.columnPx(i) + 0.5) / width_px * 2 - 1));
      positions.push_back(static_cast<float>((mesh_.rowPx(j) + 0.5) / height_px * 2 - 1));
    }
  }
  const std::size_t cells = std::size_t{mesh_.columns() - 1} * (mesh_.rows() - 1);
  layout_ = gl::makeVertexArray();
  positions_ = gl::makeBuffer();
  vertices_ = gl::makeBuffer();
  indices_ = gl::makeBuffer();
  glBindVertexArray(layout_.get());
  glBindBuffer(GL_ARRAY_BUFFER, positions_.get());
  glBufferData(GL_ARRAY_BUFFER, bytesOf(positions), positions.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, bytesOf(mesh_.vertices()), nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(WarpVertex),
                        offset(offsetof(WarpVertex, texture_u_w)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(WarpVertex),
                        offset(offsetof(WarpVertex, ray_x)));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(cells * 6 * sizeof(std::uint16_t)),
               nullptr, GL_STREAM_DRAW);
}

void WarpPass::draw(const hal::WarpPlan& plan, GLuint source) {
  mesh_.update(plan);
  const auto& inner = mesh_.innerIndices();
  const auto& edge = mesh_.edgeIndices();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, source);
  glBindVertexArray(layout_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferSubData(GL_ARRAY_BUFFER, 0, bytesOf(mesh_.vertices()), mesh_.vertices().data());
  if (!inner.empty()) {
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, bytesOf(inner), inner.data());
    drawInner(plan);
  }
  if (!edge.empty()) {
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, bytesOf(inner), bytesOf(edge), edge.data());
    drawEdge(plan);
  }
}

void WarpPass::drawInner(const hal::WarpPlan& plan) {
  glUseProgram(inner_.get());
  setGain(inner_at_.gain_rgb, plan);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh_.innerIndices().size()), GL_UNSIGNED_SHORT,
                 nullptr);
}

void WarpPass::drawEdge(const hal::WarpPlan& plan) {
  const auto [k1, k2, p1, p2, k3] = plan.lens.distortion;
  const auto narrow = [](double value) { return static_cast<float>(value); };
  // A radius without a limit must not become an infinity inside the shader.
  const double max_radius2 = std::min(plan.lens.max_radius * plan.lens.max_radius, 1e30);
  glUseProgram(edge_.get());
  setGain(edge_at_.gain_rgb, plan);
  glUniform2f(edge_at_.focal_px, narrow(plan.lens.fx_px), narrow(plan.lens.fy_px));
  glUniform2f(edge_at_.centre_px, narrow(plan.lens.cx_px), narrow(plan.lens.cy_px));
  glUniform3f(edge_at_.radial, narrow(k1), narrow(k2), narrow(k3));
  glUniform2f(edge_at_.tangential, narrow(p1), narrow(p2));
  glUniform1f(edge_at_.max_radius2, narrow(max_radius2));
  glUniform2f(edge_at_.source_px, static_cast<float>(plan.source.width_px),
              static_cast<float>(plan.source.height_px));
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh_.edgeIndices().size()), GL_UNSIGNED_SHORT,
                 offset(mesh_.innerIndices().size() * sizeof(std::uint16_t)));
}

}  // namespace ui
